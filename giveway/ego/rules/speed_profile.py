"""The free speed of an ego along its path if its lanes set it: ``reference_speed = lane``.

Three limits cap the speed: those of the lanes, those of the vehicle (the highest speed of its
controller, and the speed from which its safety layer can stop), and comfort in bends, where
v^2 times the curvature is at most the side friction at the speed v. A pass backwards from the end
of the path lets the ego brake in time for a lower limit, with the comfortable deceleration.
"""

import math
from collections.abc import Sequence

import numpy as np

from controller import LongitudinalModel, SafetyLayer
from controller.driving_constants import COMFORTABLE, SIDE_FRICTION
from giveway.config.option import LANE
from giveway.ego.perception.path_ahead import PathView
from giveway.ego.waiting_ego import WaitingEgo
from giveway.errors import ScenarioError
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import SpeedLimit

_SLOWEST = 0.1  # least speed [m/s] of the profile, so that the ego never stands still for it
_GRAVITY = 9.81  # [m/s^2]
_MPH = 0.44704  # [m/s] one mile per hour
_SPEEDS: Array = np.arange(_SLOWEST, 60.0, 0.1)  # [m/s] at which the side friction is tabulated
# Curvature [1/m] at which each of these speeds is just comfortable
_SHARPEST: Array = (
    _GRAVITY * np.interp(_SPEEDS, _MPH * np.array(SIDE_FRICTION[0]), SIDE_FRICTION[1]) / _SPEEDS**2
)
_ROUNDING = 1e-9  # rounding error [m^2/s^2] of squared speeds
_SPACING = 0.5  # spacing [m] of the stations at which the profile is known
_EARLY = 1.0  # Distance [m] before and behind a place, at which the curvature counts there too
_PREVIEW = 0.3  # lag [s] of a controller behind a falling reference speed


class SpeedProfile:
    """The speed of a free ego at each station of its path.

    Args:
        path: Path of the ego.
        limits: Speed limits of the lanes along it, in order.
        length: Length of its body [m].
        capable: Highest speed [m/s] of the vehicle on any lane.
        deceleration: Deceleration b [m/s^2] before a lower limit and before a bend.
        departure: Station [m] at which the ego enters.

    Attributes:
        speeds: Speeds (k,) [m/s] at the stations 0, 0.5 m, 1 m, ...
        fastest: Highest speed [m/s] from the departure on.
    """

    def __init__(
        self,
        path: EgoPath,
        limits: Sequence[SpeedLimit],
        *,
        length: float,
        capable: float,
        deceleration: float,
        departure: float = 0.0,
    ) -> None:
        self._deceleration = deceleration
        stations: Array = _SPACING * np.arange(math.ceil(path.length / _SPACING) + 1.0)
        self._stations, self._capable = stations, capable
        self._in_bends = in_bends(path, length, stations)
        self.change(limits)
        self.fastest = float(self.speeds[int(max(0.0, departure) / _SPACING) :].max())

    def change(self, limits: Sequence[SpeedLimit]) -> None:
        """Take over other speed limits of the lanes; ``fastest`` stays as it is.

        Args:
            limits: Speed limits of the lanes along the path, in order.
        """
        stations = self._stations
        capped = np.minimum(of_lanes(limits, stations), self._in_bends)
        capped = np.maximum(np.minimum(capped, self._capable), _SLOWEST)
        # Braking reduces v^2 by 2 b per metre, so v^2 + 2 b s must not decrease along the path.
        braking = 2.0 * self._deceleration * stations
        squares = np.minimum.accumulate((capped**2 + braking)[::-1])[::-1] - braking
        squares = np.where(squares < capped**2 - _ROUNDING, squares, capped**2)
        self.speeds: Array = np.sqrt(squares)
        self._squares: list[float] = squares.tolist()
        durations = 2.0 * _SPACING / (self.speeds[1:] + self.speeds[:-1])
        self._times: Array = np.concatenate([[0.0], np.cumsum(durations)])

    def at(self, station: float) -> float:
        """The speed [m/s] at ``station`` [m]; the last one beyond the path's end."""
        squares = self._squares
        place = max(0.0, station) / _SPACING
        i = int(place)
        if i + 1 >= len(squares):
            return math.sqrt(squares[-1])
        return math.sqrt(squares[i] + (place - i) * (squares[i + 1] - squares[i]))

    def limit(self, station: float, speed: float) -> float:
        """The limit [m/s] of the controller's reference speed; inf if it is not below ``fastest``.

        The controller follows with a lag, so the limit looks ahead by a short time.

        Args:
            station: Station of the front bumper [m].
            speed: Speed of the ego [m/s].
        """
        lowest = min(self.at(station), self.at(station + _PREVIEW * speed))
        return lowest if lowest < self.fastest else math.inf

    def duration(self, begin: float, end: float) -> float:
        """The time [s] in which a free ego drives from one station [m] to another one.

        Args:
            begin: Station [m].
            end: Station [m], not before the other one.
        """
        first, last = np.interp((begin, end), self._stations, self._times)
        return float(last - first)

    def ahead(self, station: float, speed: float, times: Array) -> Array:
        """The speed limits (N,) [m/s] of a plan at ``times`` (N,) [s] from now on.

        Args:
            station: Station of the front bumper now [m].
            speed: Speed of the ego now [m/s]. An excess is reduced with the deceleration b.
            times: Ascending times (N,) [s].
        """
        now = np.interp(station, self._stations, self._times)
        along = np.interp(now + times, self._times, self.speeds)
        return np.maximum(along, speed - self._deceleration * times)


def profile_of(
    ego: WaitingEgo,
    path: EgoPath,
    limits: Sequence[SpeedLimit],
    departure: float,
    length: float,
    capable: float,
    time_step: float,
) -> SpeedProfile:
    """The speed profile of an ego that drives as fast as its lanes allow.

    Args:
        ego: Ego before its departure.
        path: Path of the ego.
        limits: Speed limits of the lanes along it.
        departure: Station [m] of the front bumper.
        length: Length of the body [m].
        capable: Highest speed [m/s] of the vehicle.
        time_step: Control step of the co-simulation [s].

    Raises:
        ScenarioError: there are no lanes along the path.
    """
    config = ego.config
    if not limits:
        raise ScenarioError(
            f"[regulation] reference_speed = {LANE}: the path of ego '{ego.id}' follows no lanes; "
            "expected a speed [m/s], like 4"
        )
    capable = min(capable, config.vehicle.speed_max)
    if ego.safety is not None:
        vehicle = config.vehicle
        model = LongitudinalModel(vehicle.mass, vehicle.friction, time_step)
        capable = min(capable, SafetyLayer(model, ego.safety).fastest)
    hardest = config.vehicle.acceleration_limit
    return SpeedProfile(
        path,
        limits,
        length=length,
        capable=capable,
        deceleration=min(COMFORTABLE, hardest),
        departure=departure,
    )


def of_lanes(limits: Sequence[SpeedLimit], stations: Array) -> Array:
    """The lanes' limits (k,) [m/s] at ``stations`` (k,) [m]; the lower one where two lanes meet."""
    speeds: Array = np.full(len(stations), math.inf)
    begins = [limit.station for limit in limits]
    for limit, end in zip(limits, [*begins[1:], math.inf], strict=True):
        touched = (stations > limit.station - _SPACING) & (stations < end + _SPACING)
        speeds[touched] = np.minimum(speeds[touched], limit.speed)
    return speeds


def in_bends(path: EgoPath, length: float, stations: Array) -> Array:
    """The speeds (k,) [m/s] that are comfortable in the bends at ``stations`` (k,) [m].

    Args:
        path: Path of the ego.
        length: Length of its body [m].
        stations: Stations [m] of the front bumper.
    """
    sharpness = _curvature(path, length, stations)
    return np.interp(-sharpness, -_SHARPEST, _SPEEDS)


def _curvature(path: EgoPath, length: float, stations: Array) -> Array:
    """The curvature (k,) [1/m] of the front bumper's path or of the body's turn, if that is larger.

    The means of a `PathView` reach only half of a bend's curvature where it begins. Their maximum
    over three shifts is therefore taken.
    """
    headings = np.unwrap([path.pose(station, length).heading for station in stations])
    turning = np.abs(np.gradient(headings, stations))
    view = PathView(path)
    means = [np.abs(view.curvature(stations + shift)) for shift in (-_EARLY, 0.0, _EARLY)]
    sharpest: Array = np.maximum.reduce([turning, *means])
    return sharpest
