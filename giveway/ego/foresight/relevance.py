"""The people of a crowd who can matter to an ego's plan."""

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import AT_REST, COMFORTABLE
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array, inner, kernel
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

PREDICT_ALL = 150  # number of pedestrians up to which the whole crowd is predicted
# Distance [m] to the area that the ego can reach. People who stay farther away are left out of a
# plan, unless the safety layer would act for a person at that distance.
MARGIN = 3.0

Mask = NDArray[np.bool_]


class Relevance:
    """Selects the people who matter to an ego that uses one prediction per control step.

    The others act on the plan only through those people, whom they move by less than a micrometre
    within the horizon.

    Args:
        waiting: Ego before its departure.
        span: Prediction horizon [s].
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
        """Return whether each person (n,) matters to a plan from (x, y) [m]; None if all do.

        Args:
            crowd: Crowd of n people.
            x: Coordinate of the ego [m].
            y: Coordinate of the ego [m].
            speed: Speed of the ego [m/s].
        """
        if len(crowd) <= PREDICT_ALL:
            return None
        reach = speed * self._span + self._beyond
        d_x, d_y = crowd.position[:, 0] - x, crowd.position[:, 1] - y
        within: Mask = d_x * d_x + d_y * d_y <= reach * reach
        return within


class Nearby:
    """Selects the people who matter to an ego that predicts the crowd for each manoeuvre.

    A person matters who comes, at the present velocity, within a margin of the part of the path
    that the ego's body can reach within the horizon, extended by the safe distance. The margin is
    ``MARGIN``, or the distance at which the safety layer acts if that is larger; it grows with the
    ego's speed. The influence of all others on the crowd is neglected; docs/planner.md compares
    runs.

    Args:
        waiting: Ego before its departure.
        path: Path of the ego.
        shape: Shape of its body.
        span: Prediction horizon [s].
        half_width: Half width of its corridor [m].
        time_step: Time [s] until its brake acts.
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
        self._late = 0.0 if safety is None else safety.actuator.reaction_time
        self._body = 0.0 if safety is None else safety.body_radius
        self._lunge = 0.0 if safety is None else safety.walking_acceleration

    def of(self, crowd: Crowd, front: float, speed: float) -> Mask:
        """Return whether each person (n,) matters to a plan from station ``front`` [m] on.

        Args:
            crowd: Crowd of n people.
            front: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
        """
        path, span = self._path, self._span
        reach = min(speed * span + self._gain, max(speed, self._wanted) * span)
        stop = self._time_step + self._late + speed / self._strongest
        ahead = max(self._ahead, speed * speed / (2.0 * COMFORTABLE) + AT_REST - reach)
        margin = max(MARGIN, self._body + self._lunge / 2.0 * stop * stop)
        mask = np.empty(len(crowd), dtype=np.bool_)
        come_near(
            (path.vertices, path.stations),
            (front - self._behind, front + reach + ahead),
            (crowd.position, crowd.velocity),
            span,
            self._half_width + margin,
            mask,
        )
        return mask


@kernel
def come_near(
    path: tuple[Array, Array],
    part: tuple[float, float],
    people: tuple[Array, Array],
    span: float,
    margin: float,
    mask: Mask,
) -> None:
    """Fill ``mask`` (n,): whether a person who walks straight on comes close to a part of a path.

    Args:
        path: Vertices of the path, which goes on straight beyond its ends, and their stations [m].
        part: Stations [m] at which the part begins and ends.
        people: Positions (n, 2) [m] of people, and velocities (n, 2) [m/s], constant over the
            ``span``.
        span: Time [s] that is looked ahead.
        margin: Distance [m] that counts as close.
        mask: Marks (n,), filled.
    """
    (vertices, stations), (begin, end), (position, velocity) = path, part, people
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
    """Return whether a straight walk stays farther than ``margin`` from a segment of the path.

    The segment is the x axis between 0 and ``length`` [m].
    """
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
