"""Places for people to start from so that they cross a vehicle's path."""

from typing import NamedTuple

import numpy as np
import shapely

from giveway.walkways.gates import Array
from giveway.walkways.network import WalkNetwork

_HALF = 3.0  # Half side [m] of the square in which they start
_BESIDE = 7.0  # Distance [m] from the path if there is no walkway beside it
_NEAREST, _FARTHEST = 2.0, 25.0  # Distances [m] from the path if there is a walkway beside it
_HEAD_START = 20.0  # Distance [m] that the vehicle drives before it comes by
_PREFERRED = 0.4  # Share of the path at which they preferably cross


class SpawnPlace(NamedTuple):
    """A place where people start, and the length of their walk."""

    area: tuple[float, float, float, float]  # [m] x_min, y_min, x_max, y_max
    walk: tuple[float, float]  # [m] shortest and longest walk

    @property
    def flags(self) -> str:
        """The flags of the command line for the place."""
        area, walk = (",".join(f"{number:.1f}" for number in part) for part in self)
        return f"--spawn-area={area} --walk={walk}"


def beside(way: Array, network: WalkNetwork, near: tuple[float, float] | None = None) -> SpawnPlace:
    """Return a place beside a path from which people walk straight across it.

    Args:
        way: Path (k, 2) [m] of the vehicle from departure to goal, k >= 2.
        network: Network in which people walk.
        near: Point [m] to which the place is to be as near as possible, or None for any place.
    """
    line = shapely.LineString(way)
    wanted = _PREFERRED * line.length if near is None else line.project(shapely.Point(near))
    earliest = min(_HEAD_START, line.length / 2)
    station = float(np.clip(wanted, earliest, max(earliest, line.length - _HALF)))
    places = (line.interpolate(at) for at in (station, station - 0.5))
    middle, behind = (np.array(place.coords[0][:2]) for place in places)
    side = network.nearest_place(*middle)
    across = np.zeros(2) if side is None else np.array(side) - middle
    if not _NEAREST <= np.hypot(*across) <= _FARTHEST:
        along = (middle - behind) / max(float(np.hypot(*(middle - behind))), 1e-9)
        across = _BESIDE * np.array([along[1], -along[0]])  # to the right of the path
    x, y = middle + across
    return SpawnPlace(
        (float(x - _HALF), float(y - _HALF), float(x + _HALF), float(y + _HALF)),
        (float(-2.0 * across[0]), float(-2.0 * across[1])),
    )
