"""The accelerations, speeds and safe times of egos, and of others as egos expect them.

The planner, the rules of the road, the safety of their plans and the law that judges drives share
these constants. The sources name where a value comes from; the others are giveway's own choice.
"""

from typing import Final

STANDING: Final = 0.2
"""Speed [m/s] below which a vehicle counts as standing (Yang & Özgüner 2019: an obstacle)."""

PASSING_NEAR: Final = 0.6, 2.8
"""Speed [m/s] beside a person at contact, and its rise [1/s] with the clearance. Together with
``PASSING_FAR`` it is near what 85 % of the recorded drivers of DUT (Yang et al., IEEE IV 2019) do
not exceed: 1.6 m/s at 0 to 0.3 m, 2.7 m/s at 0.5 to 1 m."""

PASSING_FAR: Final = 2.4, 1.3
"""The same for more than 1.2 m. The faster site of DUT, the roundabout, has 5 to 6 m/s there."""

PASSING_KERB: Final = 1.0, 30.0 / 3.6
"""Clearance [m] from which on people who do not head for the way are passed with at least this
speed [m/s]: 30 km/h, the limit where people walk beside cars (WHO, Speed management, 2008)."""

PASSING_SIDEWALK: Final = 1.5
"""Clearance [m] from which on people on a sidewalk slow nobody down: the distance that the German
road traffic regulations demand beside people on foot in towns (StVO 2020, section 5 (4))."""

PASSING_TAIL: Final = 0.5, 1.5
"""Clearance [m] of people beside the rear half up to which this speed [m/s] is kept. People walk
behind a car that has passed them: all close passes in DUT's roundabout clips are there."""

AT_REST: Final = 1.3
"""Distance [m] from the middle of a person in front at which the ego comes to rest; giveway's own
choice."""

CREEPING: Final = 0.8
"""Highest speed [m/s] towards people in front who let nobody through; giveway's own choice. Drivers
creep into shared space at walking speed or less."""

CREEPS_NEARER: Final = 0.45
"""Distance [m] by which a creeping ego comes nearer to who sees it than it otherwise stops: 0.5 m
to the body; giveway's own choice."""

CREEPS_PAST: Final = 0.2
"""Distance [m] at which a creeping ego passes people beside its way; giveway's own choice. Others
count as in front, as they do within the wider corridor of an ego that does not creep."""

PATIENCE: Final = 5.0
"""Time [s] for which an ego waits for people before it creeps; giveway's own choice."""

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

SIDE_FRICTION: Final = (
    (10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0),
    (0.38, 0.32, 0.27, 0.23, 0.20, 0.18, 0.16, 0.15, 0.14, 0.13, 0.12, 0.11, 0.10, 0.09, 0.08),
)
"""Speeds [mph], and the largest lateral acceleration [g] in a bend at each: the side friction that
drivers still find comfortable (AASHTO, A Policy on Geometric Design of Highways and Streets, 2011,
section 3.3)."""

STOPS_AT_YELLOW: Final = 2.5
"""Deceleration [m/s²] with which others stop at a yellow light; giveway's own choice."""

SAFE_TIME: Final = 1.0
"""Time [s] between the ego and a road user who passes its path after it, or a person who passes its
path before it; giveway's own choice."""

SAFE_TIME_BEHIND: Final = 0.5
"""Time [s] behind a vehicle that passes the ego's path before it, or behind a person for whom the
ego has already waited; giveway's own choice."""

VEHICLE_GAP: Final = 2.0
"""Gap [m] to a vehicle ahead at rest: s_0 of city traffic (Treiber & Kesting, Traffic Flow
Dynamics, 2013, table 11.2)."""

VEHICLE_HEADWAY: Final = 1.0
"""Time gap [s] to a vehicle ahead, to which the age of what is known of it is added (ibid.)."""

RESTORING: Final = 1.5
"""Deceleration [m/s²] with which a gap is restored that a vehicle has cut into, unless it brakes or
the gap closes; b of city traffic (ibid.)."""

RESPONSE: Final = 4.4
"""Deceleration [m/s²] of the ego's response to a vehicle ahead that brakes as hard as it can: just
below SUMO's default `decel` of 4.5 m/s²; the rest of the brake is kept for cut-ins."""

EMERGENCY_BRAKING: Final = 9.0
"""Deceleration [m/s²] of a vehicle ahead in an emergency: SUMO's default `emergencyDecel` of a car.
"""
