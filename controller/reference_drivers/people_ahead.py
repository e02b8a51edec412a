"""The positions of people along the way ahead, and their motion across it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array
from controller.observation import Observation

SIGHT, SPACING = 40.0, 0.5  # sight distance [m] along the way, and spacing [m] of its points
STATIONS = np.arange(0.0, SIGHT, SPACING)


class PeopleAhead(NamedTuple):
    """The position of each person relative to the way ahead, and the speed across it."""

    distance: Array  # distances (n,) [m] along the way
    aside: Array  # distances (n,) [m] from the middle of the way, >= 0
    towards: Array  # speeds (n,) [m/s] towards the middle of the way

    @property
    def in_sight(self) -> NDArray[np.bool_]:
        """The marks (n,) of people who are ahead and within sight."""
        return np.asarray((self.distance > 0.0) & (self.distance < SIGHT), dtype=np.bool_)


def people_ahead(seen: Observation) -> PeopleAhead | None:
    """Return the people of an observation, or None without people or without a path."""
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
