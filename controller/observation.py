"""The observation of a controller at one instant: groups of values, refilled in place."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field
from math import inf
from operator import attrgetter
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from controller._jit import Array
from controller.defaults import SAFE_DISTANCE
from controller.foresight import Foresight

_NO_STEPS: Array = np.empty(0)


class PathAhead(Protocol):
    """The ego's path from its front bumper on. Values are computed only when asked for."""

    def remaining(self) -> float:
        """The remaining length [m] of the path."""

    def poses(self, distances: Array) -> Array:
        """The poses (k, 3) of the path, x, y [m], heading [rad], ``distances`` (k,) [m] ahead."""

    def curvature(self, distances: Array) -> Array:
        """The curvatures (k,) [1/m], positive to the left, at ``distances`` (k,) [m] ahead."""


class People(Protocol):
    """The pedestrians as the ego sees them."""

    @property
    def position(self) -> Array:
        """The centres (n, 2) [m], in the network's frame."""

    @property
    def velocity(self) -> Array:
        """The velocities (n, 2) [m/s]."""


@dataclass(slots=True)
class EgoState:
    """The state of the ego.

    Attributes:
        position: Station x_1(k) [m] of the point that keeps the safe distance.
        speed: Speed x_2(k) [m/s].
        acceleration: Acceleration [m/s^2].
        force: Force u(k-1) [N] that acted in the step before.
        path: Path from the front bumper on, or None for an endless straight line.
    """

    position: float = 0.0
    speed: float = 0.0
    acceleration: float = 0.0
    force: float = 0.0
    path: PathAhead | None = None


@dataclass(slots=True)
class RoadAhead:
    """The obstacles in front of the ego, now and over the horizon; inf without an obstacle.

    Attributes:
        gap: Distance [m] from `position` to the closest obstacle in front.
        obstacle_positions: Stations x_p(k+1) ... x_p(k+N), (N,) [m], of the closest obstacle.
        person_gap: Distance [m] from `position` to the closest person in front.
        leader_gap: Distance [m] from `position` to the vehicle in front.
        leader_speed: Speed [m/s] of that vehicle.
        stop_gap: Distance [m] from the front bumper to where it has to stop.
        to_clear: Keep-clear distance [m], to drive until the ego has left the crossings and
            junctions that it is on.
    """

    gap: float = inf
    obstacle_positions: Array = field(default_factory=lambda: _NO_STEPS)
    person_gap: float = inf
    leader_gap: float = inf
    leader_speed: float = 0.0
    stop_gap: float = inf
    to_clear: float = 0.0


@dataclass(slots=True)
class Limits:
    """The limits that the ego has to keep to.

    Attributes:
        speed_limit: Speed limit [m/s] for a stop line, a vehicle ahead or the lane; inf without.
        lane_speeds: Speed limits (N,) [m/s] of the lanes at k+1 ... k+N, or None without limits.
        safe_distance: Distance d_safe [m] to be kept to obstacles.
    """

    speed_limit: float = inf
    lane_speeds: Array | None = None
    safe_distance: float = SAFE_DISTANCE


@dataclass(slots=True)
class SeenPeople:
    """The pedestrians as the ego perceives them.

    Attributes:
        people: Perceived pedestrians (n,), or None without any.
        ids: Id (n,) of each of them, which a person keeps during the run.
        foresight: Prediction of how they react to a manoeuvre, or None if nobody can get in the
            way within the horizon.
    """

    people: People | None = None
    ids: NDArray[np.int64] | None = None
    foresight: Foresight | None = None


@dataclass(slots=True)
class Traffic:
    """All vehicles, the ego included.

    Attributes:
        poses: Poses (N, m, 7) of the vehicles, now and predicted: x, y [m], heading [rad], speed
            [m/s], distances to the front and to the rear [m], width [m]; None if the ego is alone.
        row: Row of the ego in ``poses``.
    """

    poses: Array | None = None
    row: int = 0


class _Short(property):
    """A field of a group that can be read from the observation itself."""

    def __init__(self, group: str, name: str) -> None:
        super().__init__(attrgetter(f"{group}.{name}"), doc=f"The same as ``{group}.{name}``.")
        self.place = group, name


def _short(group: str, name: str) -> Any:
    return _Short(group, name)


class Observation:
    """The observation at t_k. Values that are not known have a default.

    An ego has one observation, which is refilled in each control step. Its arrays belong to the
    co-simulation. All are valid until the force is returned, and must not be changed. A controller
    that wants to keep something copies it.

    Args:
        position: Station [m] of the point that keeps the safe distance.
        speed: Speed [m/s].
        gap: Distance [m] to the closest obstacle in front.
        obstacle_positions: Stations (N,) [m] of the closest obstacle in front.
        speed_limit: Speed limit [m/s].
        **others: Further values by their short names.

    Attributes:
        ego: State of the ego.
        ahead: Obstacles in front of the ego.
        limits: Limits that the ego has to keep to.
        pedestrians: Pedestrians as the ego perceives them.
        traffic: All vehicles.
        time: SUMO's clock t_k [s].

    Raises:
        TypeError: an observation has no value of that name.
    """

    __slots__ = ("ahead", "ego", "limits", "pedestrians", "time", "traffic")

    position: float = _short("ego", "position")
    speed: float = _short("ego", "speed")
    acceleration: float = _short("ego", "acceleration")
    force: float = _short("ego", "force")
    path: PathAhead | None = _short("ego", "path")
    gap: float = _short("ahead", "gap")
    obstacle_positions: Array = _short("ahead", "obstacle_positions")
    person_gap: float = _short("ahead", "person_gap")
    leader_gap: float = _short("ahead", "leader_gap")
    leader_speed: float = _short("ahead", "leader_speed")
    stop_gap: float = _short("ahead", "stop_gap")
    to_clear: float = _short("ahead", "to_clear")
    speed_limit: float = _short("limits", "speed_limit")
    lane_speeds: Array | None = _short("limits", "lane_speeds")
    safe_distance: float = _short("limits", "safe_distance")
    people: People | None = _short("pedestrians", "people")
    person_ids: NDArray[np.int64] | None = _short("pedestrians", "ids")
    foresight: Foresight | None = _short("pedestrians", "foresight")
    vehicles: Array | None = _short("traffic", "poses")
    row: int = _short("traffic", "row")

    def __init__(
        self,
        position: float = 0.0,
        speed: float = 0.0,
        gap: float = inf,
        obstacle_positions: Array = _NO_STEPS,
        speed_limit: float = inf,
        **others: Any,
    ) -> None:
        self.ego = EgoState(position, speed)
        self.ahead = RoadAhead(gap, obstacle_positions)
        self.limits = Limits(speed_limit)
        self.pedestrians, self.traffic = SeenPeople(), Traffic()
        self.time = 0.0
        self._fill(others)

    def replaced(self, **values: Any) -> Observation:
        """Return a copy with its own groups, in which some values are replaced.

        Args:
            **values: New values by their short names.

        Raises:
            TypeError: an observation has no value of that name.
        """
        own: Observation = copy(self)
        own.ego, own.ahead, own.limits = copy(self.ego), copy(self.ahead), copy(self.limits)
        own.pedestrians, own.traffic = copy(self.pedestrians), copy(self.traffic)
        own._fill(values)
        return own

    def _fill(self, values: dict[str, Any]) -> None:
        """Set values by their short names."""
        for name, value in values.items():
            if name == "time":
                self.time = value
                continue
            place = _PLACES.get(name)
            if place is None:
                msg = f"Observation({name} = ...): expected one of time, {', '.join(_PLACES)}"
                raise TypeError(msg)
            setattr(getattr(self, place[0]), place[1], value)


_PLACES = {name: p.place for name, p in vars(Observation).items() if isinstance(p, _Short)}
