"""Where people are along the way ahead, and how they move across it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array
from controller.observation import Observation

SIGHT, SPACING = 40.0, 0.5  # [m] of the way ahead that is looked at, and between its points
STATIONS = np.arange(0.0, SIGHT, SPACING)


class PeopleAhead(NamedTuple):
    """Of each person: the distance along the way, that from its middle, the speed towards that."""

    distance: Array  # (n,) [m]
    aside: Array  # (n,) [m] >= 0
    towards: Array  # (n,) [m/s]

    @property
    def in_sight(self) -> NDArray[np.bool_]:
        """(n,) whether they are ahead and not too far."""
        return np.asarray((self.distance > 0.0) & (self.distance < SIGHT), dtype=np.bool_)


def people_ahead(seen: Observation) -> PeopleAhead | None:
    """The people of an observation; None: there is nobody, or no way."""
    if seen.path is None or seen.people is None or not len(seen.people.position):
        return None
    way = seen.path.poses(STATIONS)
    apart = seen.people.position[:, None] - way[None, :, :2]  # (n, k, 2)
    nearest = np.hypot(apart[..., 0], apart[..., 1]).argmin(axis=1)
    people = np.arange(len(nearest))
    heading = way[nearest, 2]
    off, v = apart[people, nearest], seen.people.velocity
    along = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
    aside = off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)
    towards = -np.sign(aside) * (v[:, 1] * np.cos(heading) - v[:, 0] * np.sin(heading))
    return PeopleAhead(STATIONS[nearest] + along, np.abs(aside), towards)
