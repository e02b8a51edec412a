"""The time for which people stand, by crossing and by edge, with the manual's level of service."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.metrics.travel import level_of_service
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.footways import Footways
from giveway.run_data.tracks import CrowdTrack

GAP_LEVELS: Final = ((5.0, "A"), (10.0, "B"), (20.0, "C"), (30.0, "D"), (45.0, "E"))
"""Largest mean delay [s] of people at a crossing without a light, and its level; F beyond (Highway
Capacity Manual, 6th ed., 2016, exhibit 20-3)."""

LIGHT_LEVELS: Final = ((10.0, "A"), (20.0, "B"), (30.0, "C"), (40.0, "D"), (60.0, "E"))
"""The same at a light (Highway Capacity Manual, 2000, exhibit 18-9)."""

_STANDING = 0.1  # speed [m/s] below which a person stands; SUMO's
_BEFORE = 3.0  # distance [m] before a kerb within which people wait for the crossing; own choice
_ASIDE = 1.5  # distance [m] beside a crossing within which they do; own choice


@dataclass(frozen=True)
class Waiting:
    """One row of ``waiting.csv``."""

    id: Annotated[str, Quantity(None, "SUMO id of the crossing's lane, or of the edge")]
    kind: Annotated[str, Quantity(None, "`crossing` or `edge`")]
    people: Annotated[int, Quantity(None, "people who were there, or waited to cross")]
    stood: Annotated[int, Quantity(None, "those of them who stood there")]
    mean_waiting: Annotated[float, Quantity("s", "mean time for which they stood")]
    waiting_95: Annotated[float, Quantity("s", "95th percentile of this time")]
    longest_waiting: Annotated[float, Quantity("s", "longest time")]
    level_of_service: Annotated[
        str, Quantity(None, "A to F of the mean, by the Highway Capacity Manual; empty: an edge")
    ]


WAITING_FIELDS = columns_of(Waiting)


def waiting_by_footway(time: Array, crowd: CrowdTrack, footways: Footways) -> tuple[Waiting, ...]:
    """Return how long people stood at each crossing and on each edge, those with people alone.

    A person stands below 0.1 m/s, and waits for a crossing within 3 m before and 1.5 m beside it.
    All other places belong to the nearest edge.

    Args:
        time: Control instants (T,) [s].
        crowd: The people.
        footways: Crossings and edges of the network.
    """
    recorded, counted = np.zeros(len(time), dtype=np.bool_), []
    for part in crowd.by_people():
        recorded[part.step] = True
        counted.append(_counted(part, footways))
    steps = np.flatnonzero(recorded)
    if not len(steps):
        return ()
    each = float(np.median(np.diff(time[steps]))) if len(steps) > 1 else 0.0
    at, stood = (np.concatenate(column) for column in zip(*counted, strict=True))
    return tuple(_rows(at, each * stood, footways))


def _counted(crowd: CrowdTrack, footways: Footways) -> tuple[NDArray[np.int64], Array]:
    """Return the footway (m,) of each person who counts there, and their records that stand."""
    stands = np.hypot(crowd.vx, crowd.vy) < _STANDING
    at, counts = _places(crowd, stands, footways)
    here, people = counts & (at >= 0), len(crowd.ids)
    keys, inverse = np.unique(at[here] * people + crowd.pedestrian[here], return_inverse=True)
    stood = np.bincount(inverse, weights=stands[here], minlength=len(keys))
    return keys // people, stood.astype(np.float64)


def _places(
    crowd: CrowdTrack, stands: NDArray[np.bool_], footways: Footways
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Return the footway (R,) of each record, -1 for none, and whether it makes the person count.

    Somebody who walks past a crossing's kerb does not count there.
    """
    crossings, edges = footways
    points = shapely.points(crowd.x, crowd.y)
    at, counts = np.full(len(points), -1, dtype=np.int64), np.ones(len(points), dtype=np.bool_)
    if edges:
        tree = shapely.STRtree([shapely.LineString(edge.points) for edge in edges])
        at = len(crossings) + np.asarray(tree.nearest(points), dtype=np.int64)
    for number, crossing in enumerate(crossings):
        first, last = crossing.points[0], crossing.points[-1]
        length = max(float(np.hypot(*(last - first))), 1e-9)
        along = (last - first) / length
        d_x, d_y = crowd.x - first[0], crowd.y - first[1]
        u, w = d_x * along[0] + d_y * along[1], np.abs(d_y * along[0] - d_x * along[1])
        beside = w <= crossing.width / 2.0 + _ASIDE
        here = beside & (u >= -_BEFORE) & (u <= length + _BEFORE)
        at[here] = number
        counts[here] = (stands | ((u >= 0.0) & (u <= length)))[here]
    return at, counts


def _rows(at: NDArray[np.int64], stood: Array, footways: Footways) -> Iterator[Waiting]:
    """Yield the rows of footways with people, crossings first.

    Args:
        at: Footway (m,) of each person on it.
        stood: Time (m,) [s] for which this person stood there.
        footways: Crossings and edges of the network.
    """
    ways = (*footways.crossings, *footways.edges)
    for number in np.unique(at).tolist():
        here = stood[at == number]
        mean, is_crossing = float(here.mean()), number < len(footways.crossings)
        levels = LIGHT_LEVELS if ways[number].light else GAP_LEVELS
        yield Waiting(
            id=ways[number].id,
            kind="crossing" if is_crossing else "edge",
            people=len(here),
            stood=int((here > 0.0).sum()),
            mean_waiting=mean,
            waiting_95=float(np.percentile(here, 95)),
            longest_waiting=float(here.max()),
            level_of_service=level_of_service(mean, levels) if is_crossing else "",
        )
