"""The background vehicles that slow down, and where they are if they go on slowing down.

What is known of a vehicle is up to one step of SUMO old. A car that has braked in that step,
because it waits at its line or gives way in a junction, is expected to go on braking. At a
constant speed it would come into the ego's way until SUMO's next step puts it back.
"""

from collections.abc import Sequence

import numpy as np

from giveway.geometry.kernel import Array, inner, kernel

_BRAKES = 1.0  # deceleration [m/s^2] from which on a vehicle counts as slowing down


class Slowing:
    """Compares the speeds of the background vehicles at SUMO's last two steps.

    Args:
        step: SUMO's step [s].
    """

    def __init__(self, step: float) -> None:
        self.step = step
        self._speeds: dict[str, float] = {}  # speed [m/s] of each vehicle at the step before

    def read(self, names: Sequence[str], speeds: Array) -> Array:
        """Return the decelerations (m,) [m/s^2] in the last step; 0 for who does not slow down.

        Args:
            names: Ids of all vehicles.
            speeds: Their speeds (m,) [m/s] now.
        """
        known = self._speeds
        before = np.array([known.get(name, 0.0) for name in names])
        self._speeds = dict(zip(names, speeds.tolist(), strict=True))
        falls = (before - speeds) / self.step
        slows: Array = np.where(falls >= _BRAKES, falls, 0.0)
        return slows


@inner
def slowing_travel(speed: float, slows: float, step: float, time: float) -> float:
    """The distance [m] in a ``time`` [s] since the news of a vehicle that goes on slowing down.

    Args:
        speed: Speed [m/s] at the news.
        slows: Deceleration [m/s^2].
        step: SUMO's step [s], at whose begin the speed falls.
        time: Time [s].
    """
    v, left, travel = speed, time, 0.0
    while left > 0.0 and v > 0.0:
        v = max(v - slows * step, 0.0)
        travel += v * min(step, left)
        left -= step
    return travel


@kernel
def slow_down(
    poses: Array, news: Array, first: int, slows: Array, times: tuple[float, ...]
) -> None:
    """Set the poses of vehicles that slow down.

    Args:
        poses: Poses (N, m, 7) of all vehicles at the steps from now on, changed.
        news: Poses (b, 7) of the background vehicles at SUMO's last step.
        first: Row of the first background vehicle.
        slows: Decelerations (b,) [m/s^2].
        times: Time [s] since then, control step [s] and SUMO's step [s].
    """
    since, time_step, step = times
    for j in range(len(slows)):
        if slows[j] <= 0.0:
            continue
        x, y, heading, speed = news[j, 0], news[j, 1], news[j, 2], news[j, 3]
        for i in range(poses.shape[0]):
            time = since + i * time_step
            driven = slowing_travel(speed, slows[j], step, time)
            poses[i, first + j, 0] = x + driven * np.cos(heading)
            poses[i, first + j, 1] = y + driven * np.sin(heading)
            poses[i, first + j, 2] = heading
            poses[i, first + j, 3] = max(0.0, speed - slows[j] * time)
