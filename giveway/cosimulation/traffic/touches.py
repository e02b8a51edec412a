"""Contacts of SUMO's own vehicles with people, which no driver of SUMO notices."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.contact import signed_distance, to_frame
from giveway.geometry.kernel import Array, kernel
from giveway.sumo.background import BackgroundVehicles
from pedestrian_model import SIM

_DEPTH = 0.05  # overlap [m] from which on a person counts as touched
_SPEED = 1.0  # speed [m/s] of the vehicle from which on it counts
_MOST = 1024  # largest number of contacts at one instant


class Touches:
    """Notes which of SUMO's vehicles touch whom at more than 1 m/s and deeper than 5 cm.

    Who touches as SUMO puts the vehicle or the person onto the road does not count at that instant.
    """

    def __init__(self) -> None:
        self._first: dict[tuple[str, str], float] = {}  # time [s] of each vehicle and person
        self._known: Sequence[str] = ()  # ids of the people at the instant before
        self._there: Sequence[str] = ()  # ids of the vehicles at the instant before
        self._pairs = np.empty((_MOST, 2), dtype=np.int64)

    def update(
        self, time: float, background: BackgroundVehicles, names: Sequence[str], people: Array
    ) -> None:
        """Look for contacts.

        Args:
            time: SUMO's clock [s].
            background: SUMO's vehicles.
            names: Ids of the people.
            people: Positions (n, 2) [m] of the people.
        """
        known, there = self._known, self._there
        self._known, self._there = tuple(names), tuple(background.ids)
        fast = np.flatnonzero(background.speed > _SPEED)
        if not len(fast) or not len(people):
            return
        count = _contacts(background.bodies[fast], people, SIM.body_radius - _DEPTH, self._pairs)
        for vehicle, person in self._pairs[:count].tolist():
            pair = background.ids[fast[vehicle]], names[person]
            if pair[0] in there and pair[1] in known:
                self._first.setdefault(pair, time)

    def __len__(self) -> int:
        """The number of people whom each vehicle touched, of all vehicles together."""
        return len(self._first)

    @property
    def remark(self) -> str:
        """The number of contacts and the first of them in words; empty without one."""
        if not self._first:
            return ""
        (vehicle, person), time = next(iter(self._first.items()))
        return (
            f"SUMO's own vehicles touched people {len(self)} times at more than {_SPEED:g} m/s "
            f"(first: '{vehicle}' touched '{person}' at {time:.12g} s); they count in no table of "
            "the ego"
        )


@kernel
def _contacts(bodies: Array, people: Array, reach: float, pairs: NDArray[np.int64]) -> int:
    """Fill ``pairs`` (k, 2) with the rows of vehicle and person that touch; return their number.

    Args:
        bodies: Vehicles (m, 5): front x, y [m], heading [rad], length, width [m].
        people: Positions (n, 2) [m].
        reach: Distance [m] from a body within which a person's centre counts.
        pairs: Rows of vehicles and people, filled.
    """
    count = 0
    for j in range(bodies.shape[0]):
        x, y, heading = bodies[j, 0], bodies[j, 1], bodies[j, 2]
        half_length, half_width = bodies[j, 3] / 2.0, bodies[j, 4] / 2.0
        c, s = np.cos(heading), np.sin(heading)
        far = 2.0 * half_length + half_width + reach
        for i in range(people.shape[0]):
            d_x, d_y = people[i, 0] - x, people[i, 1] - y
            if abs(d_x) > far or abs(d_y) > far:
                continue
            along, aside = to_frame(d_x, d_y, c, s)
            if signed_distance(along + half_length, aside, half_length, half_width) >= reach:
                continue
            if count < pairs.shape[0]:
                pairs[count, 0], pairs[count, 1] = j, i
                count += 1
    return count
