"""The cost of a manoeuvre beyond its horizon: time that the ego will yet lose to people.

A horizon of a few seconds sees that to stop costs some of them, not that a whole group has to pass
before the way is free. Beyond it a base policy drives, one that can be told without predicting the
crowd again: people go where they want to, the ego arrives where they cross when they have left.
What it loses is added to the manoeuvre's cost (rollout, Bertsekas 2005).
"""

import numpy as np

from controller._jit import Array, inner

_SPAN = 6.0  # [s] beyond the horizon that it drives
_STEP = 0.25  # [s] of it
_COMFORT = 2.0  # [m/s^2] of stopping behind somebody who stays
_BRAKING = 3.0  # [m/s^2] at most
_DRIVING_OFF = 2.5  # [m/s^2] at most
_DISTANCE = 1.0  # [m] kept to people


@inner
def time_to_go(crossers: Array, speed: float, wanted: float) -> float:
    """Return the time that is lost beyond the horizon [s].

    Args:
        crossers: (n, 4) who crosses, as in :class:`controller.Prospect`.
        speed: Speed at the horizon's end [m/s].
        wanted: [m/s] where nobody is in the way, > 0.
    """
    lost, at, v = 0.0, 0.0, speed
    for k in range(int(_SPAN / _STEP)):
        t = k * _STEP
        goal = wanted
        for p in range(crossers.shape[0]):
            if crossers[p, 3] <= t:
                continue
            along = crossers[p, 1]
            ahead = crossers[p, 0] + along * t - at
            if ahead < 0.0 or t + ahead / wanted < crossers[p, 2]:
                continue
            ahead = max(ahead - _DISTANCE, 0.0)
            if crossers[p, 3] - t > _SPAN:
                behind = np.sqrt(2.0 * _COMFORT * ahead)
            else:
                behind = ahead / (crossers[p, 3] - t)
            goal = min(goal, max(along, 0.0) + behind)
        v = max(0.0, v + min(max(goal - v, -_BRAKING * _STEP), _DRIVING_OFF * _STEP))
        at += v * _STEP
        lost += _STEP * max(0.0, 1.0 - v / wanted)
    return lost
