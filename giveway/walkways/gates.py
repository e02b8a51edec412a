"""Gates: lines across a route, one after the other, through which people walk side by side.

A gate spans the usable width of the walkway at one place. People cross it anywhere on its width, so
that a crowd uses the whole width and does not queue for one point. A person's side is a number from
-1 (right end of the usable width, in walking direction) to +1 (left end). People of the same side
go round the same corners.

Gates are rows of one array, so that a person's route is one concatenation of pieces that many
people share. The columns are: the middle x, y [m]; the vector x, y [m] from the middle to the left
end; the unit direction of passage x, y; the signal that people wait for here, or -1.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Place = tuple[float, float]

BODY_RADIUS = 0.27  # Body radius [m] of a pedestrian: half of a shoulder breadth of 0.54 m
TRACKS = 2  # Tracks to either side of the middle: people on one track go round the same corners
NO_GATES: Array = np.empty((0, 7))
_NO_SIGNAL = -1
# Cosine of the angle between a route and the direction of a gate's passage; with a smaller one,
# people come from the side of the gate
_ASKEW = 0.2
_THERE = 0.01  # Distance [m] to a gate within which a person is at it, and comes from no direction


def gate(
    middle: Array | tuple[float, float],
    direction: Array,
    half_width: float = 0.0,
    *,
    signal: int = _NO_SIGNAL,
) -> Array:
    """Return one gate (1, 7) across ``direction`` (unit), ``half_width`` [m] to either side."""
    x, y = middle
    d_x, d_y = direction
    return np.array([[x, y, -d_y * half_width, d_x * half_width, d_x, d_y, signal]])


def turned(gates: Array) -> Array:
    """Return the same gates for the other direction, without signals, which hold for one only."""
    back = gates[::-1].copy()
    back[:, 2:6] *= -1.0
    back[:, 6] = _NO_SIGNAL
    return back


def track_of(side: float) -> int:
    """Return the track, -TRACKS to TRACKS, of a person on ``side`` [-1, 1]."""
    return round(side * TRACKS)


def places(gates: Array, side: float) -> Array:
    """Return the places (k, 2) [m] of a person on ``side`` [-1, 1] in each gate."""
    return gates[:, 0:2] + side * gates[:, 2:4]


def passages(gates: Array, start: tuple[float, float]) -> Array:
    """Return unit direction and half width [m] (k, 3) of the passage through each gate.

    The half width is the usable one plus a body's radius: the whole walkway, and nothing beside it.
    Some gates are reached from behind their line, as round a corner to a kerb. Their direction of
    passage is the one in which people come, because with the gate's own direction people would have
    passed the line before they reach it. At a gate with a light, the line always is the kerb's. A
    line across the way of people who come along the kerb may lead onto the roadway, and other
    people would push them along it.

    Args:
        gates: Gates (k, 7).
        start: Place [m] from which the person comes.
    """
    rows = np.empty((len(gates), 3))
    rows[:, :2] = gates[:, 4:6]
    rows[:, 2] = np.hypot(gates[:, 2], gates[:, 3]) + BODY_RADIUS
    steps = gates[:, :2].copy()
    steps[0] -= start
    steps[1:] -= gates[:-1, :2]
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    ahead = steps[:, 0] * rows[:, 0] + steps[:, 1] * rows[:, 1]
    askew = (ahead < _ASKEW * lengths) & (lengths > _THERE) & (gates[:, 6] < 0)
    if askew.any():
        rows[askew, :2] = steps[askew] / lengths[askew, None]
    return rows


def signals(gates: Array) -> NDArray[np.int64]:
    """Return the signal (k,) at each gate, or -1 if it has none."""
    return gates[:, 6].astype(np.int64)


def side_at(gates: Array, position: tuple[float, float]) -> float:
    """Return the side [-1, 1] on which a straight walk from ``position`` crosses the first gate."""
    x, y = gates[0, 0:2]
    s_x, s_y = gates[0, 2:4]
    square = s_x * s_x + s_y * s_y
    if square == 0.0:
        return 0.0
    side = ((position[0] - x) * s_x + (position[1] - y) * s_y) / square
    return float(min(1.0, max(-1.0, side)))
