"""The impact on a dummy, and how the ego braked for it, as consumer tests measure them."""

from dataclasses import dataclass
from math import inf, nan
from typing import Annotated, Any, NamedTuple

import numpy as np

from giveway.geometry.kernel import Array
from giveway.metrics.contacts import MOVING
from giveway.run_data.columns import Quantity
from giveway.run_data.tracks import CrowdTrack

DUMMY = "dummy"  # Key of [metrics] that adds these columns
BRAKES = 1.0
"""Deceleration [m/s^2] from which on the ego brakes (T_AEB of Euro NCAP)."""
_SETTLES = 2.0  # Time [s] after the departure in which an FMU settles at its speed


@dataclass(frozen=True)
class DummyOptions:
    """The dummy's box.

    Attributes:
        size: Length in the direction of the walk, and width [m].
    """

    size: tuple[float, float]


class _Impact(NamedTuple):
    """The first instant at which the front is at a dummy."""

    time: float = inf  # [s]
    speed: float = nan  # of the ego [m/s]
    relative: float = nan  # of the ego relative to the dummy along its heading [m/s]
    aside: float = nan  # of the dummy's centre, to the left of the front's middle [m]


class DummyMetric:
    """A metric of giveway's own that only brake tests have.

    Args:
        options: The dummy's box.
    """

    @dataclass(frozen=True)
    class Columns:
        """The columns that these runs have besides."""

        dummy_impact_speed: Annotated[
            float,
            Quantity(
                "m/s",
                "speed of the ego when its front reaches the dummy; empty: never",
                better="lower",
            ),
        ]
        dummy_relative_speed: Annotated[
            float, Quantity("m/s", "the same relative to the dummy, along the ego's heading")
        ]
        dummy_lateral_offset: Annotated[
            float,
            Quantity("m", "lateral offset of the dummy's centre from the front's middle then"),
        ]
        first_sight_time: Annotated[
            float, Quantity("s", "time from departure until a person is perceived; empty: never")
        ]
        first_sight_distance: Annotated[
            float, Quantity("m", "distance from the front's middle to this person then")
        ]
        first_braking_time: Annotated[
            float, Quantity("s", "time from departure until it brakes with 1 m/s²; empty: never")
        ]
        hardest_braking: Annotated[
            float,
            Quantity("m/s^2", "largest deceleration before the impact, from 2 s after departure"),
        ]

    def __init__(self, options: DummyOptions) -> None:
        self._size = options.size

    def measure(self, drive: Any) -> Columns:
        """Return the numbers of one ego's drive.

        Args:
            drive: :class:`~giveway.results.ego_result.EgoResult` of the ego.
        """
        track = drive.track
        people = drive.crowd.by_people()
        first = min((_impact(drive, each, self._size) for each in people), default=_Impact())
        since = track.time - track.time[0]
        before = (since >= _SETTLES) & (track.time <= first.time)
        braking = before & (track.acceleration <= -BRAKES)
        sights = drive.sights
        seen = np.flatnonzero(sights.seen & (sights.ego == drive.id) & (sights.pedestrian >= 0))[:1]
        return self.Columns(
            first.speed,
            first.relative,
            first.aside,
            float(sights.time[seen[0]] - track.time[0]) if seen.size else nan,
            float(sights.distance[seen[0]]) if seen.size else nan,
            float(since[braking.argmax()]) if braking.any() else nan,
            float(np.max(-track.acceleration[before], initial=0.0)),
        )


def _impact(drive: Any, person: CrowdTrack, size: tuple[float, float]) -> _Impact:
    """Return the first impact of an ego's front on one person's box."""
    track, k = drive.track, person.step
    if not k.size:
        return _Impact()
    c, s = np.cos(track.heading[k]), np.sin(track.heading[k])
    off_x, off_y = person.x - track.front_x[k], person.y - track.front_y[k]
    ahead, aside = c * off_x + s * off_y, c * off_y - s * off_x
    half_ahead, half_aside = _extents(person, c, s, size)
    gap, walks = ahead - half_ahead, c * person.vx + s * person.vy
    reached = np.flatnonzero((gap[:-1] >= 0.0) & (gap[1:] < 0.0) & (np.diff(k) == 1))
    for i in reached.tolist():
        share = float(gap[i] / (gap[i] - gap[i + 1]))

        def at(values: Array, i: int = i, share: float = share) -> float:
            return float(values[i] + share * (values[i + 1] - values[i]))

        speed, where = at(track.speed[k]), at(aside)
        if speed > MOVING and abs(where) < drive.shape.width / 2.0 + at(half_aside):
            return _Impact(at(track.time[k]), speed, speed - at(walks), where)
    return _Impact()


def _extents(
    person: CrowdTrack, c: Array, s: Array, size: tuple[float, float]
) -> tuple[Array, Array]:
    """Return half of a person's box (R,) [m] along the ego's heading, and across it.

    The box is turned to where the person walks. One who stands all the time looks across.
    """
    x, y = person.x[-1] - person.x[0], person.y[-1] - person.y[0]
    walked = float(np.hypot(x, y))
    if walked == 0.0:
        x, y, walked = -s[0], c[0], 1.0
    ahead, aside = np.abs(c * x + s * y) / walked, np.abs(c * y - s * x) / walked
    length, width = size
    return (length * ahead + width * aside) / 2.0, (length * aside + width * ahead) / 2.0
