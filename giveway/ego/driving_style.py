"""The accelerations and speeds that describe how the ego drives, and how it expects others to.

The rules of the road share these constants. The sources name where a value comes from; the others
are giveway's own choice.
"""

from typing import Final

STANDING: Final = 0.2
"""Speed [m/s] below which a vehicle counts as standing (Yang & Özgüner 2019: an obstacle)."""

COMFORTABLE: Final = 2.0
"""Deceleration [m/s²] of a driver who is not surprised; giveway's own choice."""

FIRM: Final = 3.0
"""Largest deceleration [m/s²] that priority, or regaining a distance, may cost; giveway's own."""

PULL_AWAY: Final = 1.5
"""Smallest acceleration [m/s²] with which the ego pulls away; giveway's own choice."""

PULL_AWAY_BRISK: Final = 3.0
"""Largest acceleration [m/s²] with which the ego pulls away; giveway's own choice."""

PULL_AWAY_OTHERS: Final = 2.0
"""Acceleration [m/s²] with which other vehicles that wait pull away; giveway's own choice."""
