"""The cost of a manoeuvre beyond its horizon: time that the ego will lose to later crossings.

A horizon of a few seconds shows the cost of stopping, but not that a whole group has to pass before
the path is free. Beyond the horizon a base policy drives, which needs no prediction of the crowd:
people walk where they want to, and the ego arrives at a crossing point when they have left it. The
time that this policy loses is added to the manoeuvre's cost (rollout, Bertsekas 2005).
"""

import numpy as np

from controller._jit import Array, inner
from controller.driving_constants import COMFORTABLE, DRIVE_ON, FIRM

_SPAN = 6.0  # time [s] beyond the horizon for which the base policy drives
_STEP = 0.25  # time step [s] of the base policy
_DISTANCE = 1.0  # distance [m] that the base policy keeps to people


@inner
def time_to_go(later_crossings: Array, speed: float, wanted: float) -> float:
    """Return the time [s] that is lost beyond the horizon.

    Args:
        later_crossings: Later crossings (n, 4), as in :class:`controller.Evaluation`.
        speed: Speed at the horizon's end [m/s].
        wanted: Speed [m/s] with nobody in the way, > 0.
    """
    lost, at, v = 0.0, 0.0, speed
    for k in range(int(_SPAN / _STEP)):
        t = k * _STEP
        goal = wanted
        for p in range(later_crossings.shape[0]):
            if later_crossings[p, 3] <= t:
                continue
            along = later_crossings[p, 1]
            ahead = later_crossings[p, 0] + along * t - at
            if ahead < 0.0 or t + ahead / wanted < later_crossings[p, 2]:
                continue
            ahead = max(ahead - _DISTANCE, 0.0)
            if later_crossings[p, 3] - t > _SPAN:
                behind = np.sqrt(2.0 * COMFORTABLE * ahead)
            else:
                behind = ahead / (later_crossings[p, 3] - t)
            goal = min(goal, max(along, 0.0) + behind)
        v = max(0.0, v + min(max(goal - v, -FIRM * _STEP), DRIVE_ON * _STEP))
        at += v * _STEP
        lost += _STEP * max(0.0, 1.0 - v / wanted)
    return lost
