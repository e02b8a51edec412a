"""The accelerations, speeds and safe times of egos, and of others as egos expect them.

The planner, the rules of the road, the safety of their plans and the law that judges drives share
these constants. The sources name where a value comes from; the others are giveway's own choice.
"""

from typing import Final

STANDING: Final = 0.2
"""Speed [m/s] below which a vehicle counts as standing (Yang & Özgüner 2019: an obstacle)."""

COMFORTABLE: Final = 2.0
"""Deceleration [m/s²] of a driver who is not surprised; giveway's own choice."""

FIRM: Final = 3.0
"""Largest deceleration [m/s²] that passengers accept; giveway's own choice, below the limit of
adaptive cruise control (ISO 15622: 3.5 m/s² at speed). Priority, regaining a distance and a wanted
speed may cost it, and the law demands it for a person. Manoeuvres for obstacles brake harder."""

SOFT_STOP: Final = 1.5
"""Deceleration [m/s²] of the planner's stop at the end of the way; giveway's own choice."""

BRANCHES: Final = (-2.5, -5.0)
"""Accelerations [m/s²] of a contingency plan's branches; giveway's own choice."""

DRIVE_ON: Final = 2.5
"""Largest acceleration [m/s²] that the planner expects of itself; giveway's own choice."""

PULL_AWAY: Final = 1.5
"""Smallest acceleration [m/s²] with which the ego pulls away; giveway's own choice."""

PULL_AWAY_BRISK: Final = 3.0
"""Largest acceleration [m/s²] with which the ego pulls away; giveway's own choice."""

PULL_AWAY_USUAL: Final = 2.0
"""Acceleration [m/s²] with which others that wait are expected to pull away, and with which the law
expects the ego to come nearer; giveway's own choice."""

UNHURRIED: Final = 1.0
"""Acceleration [m/s²] with which others approach a junction, and with which others expect the ego
to leave one; giveway's own choice."""

FOLLOW_LIMIT: Final = 4.0
"""Largest deceleration [m/s²] with which the tuned PID follows a falling limit; giveway's own."""

LATERAL_ACCELERATION: Final = 2.0
"""Largest lateral acceleration [m/s²] in a bend. Roads are designed for the side friction that
drivers still find comfortable: 0.20 g at 30 mph (AASHTO, A Policy on Geometric Design of Highways
and Streets, 2011, section 3.3)."""

STOPS_AT_YELLOW: Final = 2.5
"""Deceleration [m/s²] with which others stop at a yellow light; giveway's own choice."""

SAFE_TIME: Final = 1.0
"""Time [s] between the ego and a road user who passes its path after it, or a person who passes its
path before it; giveway's own choice."""

SAFE_TIME_BEHIND: Final = 0.5
"""Time [s] behind a vehicle that passes the ego's path before it, or behind a person for whom the
ego has already waited; giveway's own choice."""
