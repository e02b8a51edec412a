"""The people of a crowd who can matter to an ego's plan."""

import numpy as np
from numpy.typing import NDArray

from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

PREDICT_ALL = 150  # pedestrians; of a larger crowd only those that matter to the ego are predicted
MARGIN = 3.0  # [m] from what the ego can reach; who stays farther off is left out of a plan,
# unless the safety layer would act for somebody who is as far off

Mask = NDArray[np.bool_]


class Relevance:
    """Tells who is near enough for an ego that looks at one prediction.

    Those who are left out act on the plan only through others, and move the pedestrians that the
    ego may meet by less than a micrometre within the horizon.

    Args:
        waiting: the ego before its departure.
        span: that it looks ahead [s].
        size: Size of its body and its corridor [m].
    """

    def __init__(self, waiting: WaitingEgo, span: float, size: float) -> None:
        config, predictor = waiting.config, waiting.predictor
        strongest = config.vehicle.acceleration_limit
        self._span = span
        self._beyond = strongest * span / 2.0 * span + config.regulation.safe_distance
        self._beyond += waiting.walking_speed_limit * span + size
        if predictor is not None:
            self._beyond += predictor.parameters.interaction_radius

    def of(self, crowd: Crowd, x: float, y: float, speed: float) -> Mask | None:
        """Return who matters to a plan from (x, y) [m] at ``speed`` [m/s], (n,); None if all do."""
        if len(crowd) <= PREDICT_ALL:
            return None
        reach = speed * self._span + self._beyond
        d_x, d_y = crowd.position[:, 0] - x, crowd.position[:, 1] - y
        within: Mask = d_x * d_x + d_y * d_y <= reach * reach
        return within


class Nearby:
    """Tells who is near enough for an ego that predicts the crowd again for each manoeuvre.

    Somebody counts who, at his present velocity, comes within ``MARGIN`` of the part of the path
    that the ego's body can be on within the horizon, or its safe distance ahead of that. Who is
    left out would have to walk that far to meet the ego, and the safety layer, if there is one,
    does not act for him: the faster the ego is, the farther off it does.
    What he does to others is left out, too: docs/planner.md compares runs.

    Args:
        waiting: the ego before its departure.
        path: the ego's.
        shape: Shape of its body.
        span: that it looks ahead [s].
        half_width: Half width of its corridor [m].
        time_step: until its brake acts [s].
    """

    def __init__(
        self,
        waiting: WaitingEgo,
        path: EgoPath,
        shape: VehicleShape,
        span: float,
        half_width: float,
        time_step: float,
    ) -> None:
        config, safety = waiting.config, waiting.safety
        self._path, self._span = path, span
        self._strongest = config.vehicle.acceleration_limit
        self._gain = self._strongest / 2.0 * span * span
        wanted = config.reference_speed
        self._wanted = config.vehicle.speed_max if isinstance(wanted, str) else wanted
        self._behind, self._ahead = shape.length, config.regulation.safe_distance
        self._half_width, self._time_step = half_width, time_step
        self._body = 0.0 if safety is None else safety.body_radius
        self._lunge = 0.0 if safety is None else safety.walking_acceleration

    def of(self, crowd: Crowd, front: float, speed: float) -> Mask:
        """Return who matters to a plan from station ``front`` [m] on at ``speed`` [m/s], (n,)."""
        path, span = self._path, self._span
        reach = min(speed * span + self._gain, max(speed, self._wanted) * span)
        stop = self._time_step + speed / self._strongest
        margin = max(MARGIN, self._body + self._lunge / 2.0 * stop * stop)
        mask = np.empty(len(crowd), dtype=np.bool_)
        come_near(
            path.vertices,
            path.stations,
            front - self._behind,
            front + reach + self._ahead,
            crowd.position,
            crowd.velocity,
            span,
            self._half_width + margin,
            mask,
        )
        return mask


@kernel
def come_near(
    vertices: Array,
    stations: Array,
    begin: float,
    end: float,
    position: Array,
    velocity: Array,
    span: float,
    margin: float,
    mask: Mask,
) -> None:
    """Fill ``mask`` (n,): who comes within ``margin`` [m] of a part of a path on a straight way.

    Args:
        vertices: Vertices of the path; it goes on straight beyond its ends.
        stations: [m] of these.
        begin: station [m] where the part begins.
        end: where it ends, farther on.
        position: (n, 2) [m].
        velocity: (n, 2) [m/s], kept to for the ``span``.
        span: [s].
        margin: [m].
        mask: (n,).
    """
    mask[:] = False
    last = len(stations) - 2
    for i in range(last + 1):
        low = begin if i == 0 else max(begin, stations[i])
        high = end if i == last else min(end, stations[i + 1])
        if low > high:
            continue
        x_0, y_0, length = vertices[i, 0], vertices[i, 1], stations[i + 1] - stations[i]
        e_x, e_y = (vertices[i + 1, 0] - x_0) / length, (vertices[i + 1, 1] - y_0) / length
        x_0, y_0 = x_0 + (low - stations[i]) * e_x, y_0 + (low - stations[i]) * e_y
        for j in range(len(mask)):
            if not mask[j]:
                # In the segment's frame: along it and to its left.
                x = (position[j, 0] - x_0) * e_x + (position[j, 1] - y_0) * e_y
                y = (position[j, 1] - y_0) * e_x - (position[j, 0] - x_0) * e_y
                to_x = x + span * (velocity[j, 0] * e_x + velocity[j, 1] * e_y)
                to_y = y + span * (velocity[j, 1] * e_x - velocity[j, 0] * e_y)
                mask[j] = not _farther(x, y, to_x, to_y, high - low, margin)


@inner
def _farther(x: float, y: float, to_x: float, to_y: float, length: float, margin: float) -> bool:
    """Return whether a way stays farther than ``margin`` from the axis between 0 and ``length``."""
    if min(y, to_y) > margin or max(y, to_y) < -margin:
        return True
    if min(x, to_x) > length + margin or max(x, to_x) < -margin:
        return True
    if y * to_y <= 0.0:
        share = y / (y - to_y) if y != to_y else 0.0
        if 0.0 <= x + share * (to_x - x) <= length:
            return False
    closest = min(
        _from_segment(x, y, 0.0, 0.0, length, 0.0), _from_segment(to_x, to_y, 0.0, 0.0, length, 0.0)
    )
    closest = min(closest, _from_segment(0.0, 0.0, x, y, to_x, to_y))
    return min(closest, _from_segment(length, 0.0, x, y, to_x, to_y)) > margin


@inner
def _from_segment(x: float, y: float, a_x: float, a_y: float, b_x: float, b_y: float) -> float:
    """The distance [m] of a point to the segment from a to b."""
    d_x, d_y = b_x - a_x, b_y - a_y
    square = d_x * d_x + d_y * d_y
    share = 0.0
    if square > 0.0:
        share = min(1.0, max(0.0, ((x - a_x) * d_x + (y - a_y) * d_y) / square))
    o_x, o_y = x - a_x - share * d_x, y - a_y - share * d_y
    distance: float = np.sqrt(o_x * o_x + o_y * o_y)
    return distance
