"""The routes of people who walk with a flow: start, gates, crossings and end."""

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from giveway.config.tables.flows import FlowConfig, Place, is_line
from giveway.geometry.kernel import Array
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.walkways.reading import Signal

_BODY = 0.27  # distance [m] kept from a line's ends: half of the shoulder breadth
_BACK = 0.3  # distance [m] to the kerb at which people wait for their light


class Gate(NamedTuple):
    """A gate on people's routes: a point, or a line that they cross anywhere."""

    middle: Array  # middle (2,) [m]
    across: Array  # unit direction (2,) in which a line is crossed; 0, 0 for a point
    half_width: float  # half-width [m] of a line; 0 for a point
    signal: int = -1  # signal that has to be open; -1 without one

    def aim(self, place: Array) -> Array:
        """Return the point (2,) [m] at which a person from ``place`` (2,) passes the gate."""
        along = np.array([-self.across[1], self.across[0]])
        room = max(self.half_width - _BODY, 0.0)
        beside = float(np.clip(((place - self.middle) * along).sum(), -room, room))
        return np.asarray(self.middle + beside * along)


class LitCrossing(NamedTuple):
    """A crossing with a light."""

    kerb: Array  # middle (2,) [m] of one kerb
    along: Array  # unit direction (2,) to the other kerb
    length: float  # length [m]
    half_width: float  # half-width [m]
    signal: int  # signal that has to be open

    def gate(self, start: Array, end: Array) -> Gate | None:
        """Return the gate of a straight walk over the crossing, or None if it leads elsewhere."""
        u, w = self._place(start)
        u_end, w_end = self._place(end)
        along = self.along
        if u > u_end:  # for the other direction the other kerb is the first one
            u, u_end = self.length - u, self.length - u_end
            along = -along
        if not u <= 0.0 < self.length <= u_end:
            return None
        if abs(w - u / (u_end - u) * (w_end - w)) > self.half_width:
            return None
        kerb = self.kerb if along is self.along else self.kerb + self.length * self.along
        return Gate(kerb - _BACK * along, along, self.half_width, self.signal)

    def _place(self, at: Array) -> tuple[float, float]:
        """Return the distances [m] of a point along the crossing and to its left."""
        x, y = at - self.kerb
        d_x, d_y = self.along
        return float(x * d_x + y * d_y), float(y * d_x - x * d_y)


def lit_crossings(
    crossings: Sequence[Crossing], signals: Sequence[Signal]
) -> tuple[LitCrossing, ...]:
    """Return the crossings of the network at which people wait for their light.

    Args:
        crossings: All crossings.
        signals: Signals that the run watches, in the order of ``Surroundings.closed``.
    """
    by_edge = {signal.crossing: number for number, signal in enumerate(signals)}
    found = []
    for crossing in crossings:
        signal = by_edge.get(crossing.lane.rpartition("_")[0])
        way = crossing.ends[1] - crossing.ends[0]
        length = math.hypot(*way)
        if signal is not None and length > 0.0:
            kerb, half_width = crossing.ends[0], crossing.width / 2.0
            found.append(LitCrossing(kerb, way / length, length, half_width, signal))
    return tuple(found)


def gates_of(flow: FlowConfig) -> tuple[Gate, ...]:
    """Return the gates of a flow. Lines are crossed in the direction away from the start."""
    gates = []
    before = middle_of(flow.start)
    for place in flow.via:
        middle = middle_of(place)
        across, half = np.zeros(2), 0.0
        if is_line(place):
            first, last = corners(place)
            length = math.hypot(*(last - first))
            d_x, d_y = (last - first) / length
            across, half = np.array([d_y, -d_x]), length / 2.0
            across = across if (across * (middle - before)).sum() >= 0.0 else -across
        gates.append(Gate(middle, across, half))
        before = middle
    return tuple(gates)


def with_lights(
    start: Array, gates: Sequence[Gate], end: Array, lit: Sequence[LitCrossing]
) -> Iterator[Gate]:
    """Yield the gates of a route, with the kerbs between them at which people wait for a light."""
    at = start
    for gate in (*gates, None):
        goal = end if gate is None else gate.aim(at)
        kerbs = [kerb for crossing in lit if (kerb := crossing.gate(at, goal))]
        yield from sorted(kerbs, key=lambda kerb: math.dist(kerb.middle, at))
        if gate is not None:
            yield gate
        at = goal


def longest_way(flow: FlowConfig) -> float:
    """Return an upper bound [m] on the length of the walks of a flow."""
    boxes = [np.sort(corners(place), axis=0) for place in (flow.start, *flow.via, flow.to)]
    return sum(
        math.hypot(*np.maximum(b[1] - a[0], a[1] - b[0])) for a, b in itertools.pairwise(boxes)
    )


def corners(place: Place) -> Array:
    """Return the ends (2, 2) [m] of a line, opposite corners of a rectangle, or a point twice."""
    numbers = np.array(place, dtype=np.float64).ravel()
    return np.resize(numbers, (2, 2))


def middle_of(place: Place) -> Array:
    """Return the middle (2,) [m] of a place."""
    return np.asarray(corners(place).mean(axis=0))


def somewhere(place: Place, random: np.random.Generator) -> Array:
    """Draw a point (2,) [m] of a place, uniform on a line or rectangle."""
    low, high = corners(place)
    share = random.random() if is_line(place) else random.random(2)
    return np.asarray(low + share * (high - low))
