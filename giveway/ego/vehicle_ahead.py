"""The vehicle ahead of an ego, as old as the news of it are."""

from collections.abc import Sequence

import numpy as np

from controller import VehicleAhead
from controller.driving_constants import EMERGENCY_BRAKING
from giveway.ego.perception.leader import Followed, Leader
from giveway.geometry.kernel import Array

_NO_BRAKING: Sequence[float] = ()
_NO_DECELERATION = 1e-6  # deceleration [m/s^2] that counts as none, against a division by zero


class VehicleNews:
    """Keeps what an ego knows of the vehicle that it follows, and since when.

    Args:
        time_step: Control step [s].
    """

    def __init__(self, time_step: float) -> None:
        self._time_step = self._step = time_step
        self._age = 0.0
        self._names: Sequence[str] = ()
        self._braking: Array | Sequence[float] = _NO_BRAKING
        self._last = "", 0.0  # the vehicle followed, and its speed [m/s]
        self._station = 0.0  # its station [m] at the last news
        self._decelerates = 0.0

    def tell(self, names: Sequence[str], braking: Array, step: float) -> None:
        """Take note of SUMO's vehicles after its step.

        Args:
            names: Ids of the vehicles of the last rows.
            braking: Largest deceleration [m/s^2] of each.
            step: SUMO's step [s].
        """
        self._names, self._braking, self._step, self._age = names, braking, step, 0.0

    def look(self, followed: Followed, front: float, rows: int) -> VehicleAhead | None:
        """Return the vehicle ahead, or None without one.

        Args:
            followed: Vehicle that is followed.
            front: Station of the ego's front bumper [m].
            rows: Number of all vehicles. The first ones are egos, of which news come in each step.
        """
        station, speed, row = followed
        if row < 0:
            self._last, self._decelerates = ("", 0.0), 0.0
            return None
        i = row - (rows - len(self._names))
        if i < 0:
            name, braking, age, step = f"ego {row}", EMERGENCY_BRAKING, 0.0, self._time_step
        else:
            name, braking, age, step = self._names[i], self._braking[i], self._age, self._step
        new = name != self._last[0]
        if new:
            self._last, self._decelerates = (name, speed), 0.0
            self._station = station - speed * age
        elif age == 0.0:
            self._decelerates = max(0.0, self._last[1] - speed) / step
            self._last, self._station = (name, speed), station
        speed = self._last[1]
        return VehicleAhead(
            self._station + speed * age - front,
            speed,
            float(braking),
            self._decelerates,
            float(age),
            new,
            step,
        )

    def estimated(self, leader: Leader, ahead: VehicleAhead, front: float) -> Leader:
        """Return the leader where it is by now if it goes on braking as at the last news.

        Args:
            leader: Leader if it drove on at its speed since then.
            ahead: The same vehicle as the safety layer knows it.
            front: Station of the ego's front bumper [m].
        """
        if leader.station - front > ahead.gap or ahead.decelerates == 0.0:
            return leader
        if leader.speed < ahead.speed:
            return leader  # its pose is that of a vehicle that slows down
        falls = min(ahead.decelerates * ahead.age, leader.speed)
        return Leader(leader.station - falls * ahead.step, leader.speed - falls)

    def stations(self, leader: Leader, ahead: VehicleAhead, times: Array) -> Array:
        """The stations (N,) [m] of a leader that goes on braking as at the last news.

        Args:
            leader: Leader where it is by now.
            ahead: The same vehicle as the safety layer knows it.
            times: Times (N,) [s] from now.
        """
        stops = leader.speed / max(ahead.decelerates, _NO_DECELERATION)  # time [s] until it stands
        moves = np.minimum(times, stops)
        travel: Array = moves * (leader.speed - 0.5 * ahead.decelerates * moves)
        return leader.station + travel

    def advance(self) -> None:
        """Let the news grow older by one control step."""
        self._age += self._time_step
