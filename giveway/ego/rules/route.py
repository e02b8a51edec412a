"""The context that an ego's rules are made from: route, vehicle and running simulation."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import NamedTuple

import numpy as np

from controller.driving_constants import VEHICLE_GAP
from giveway.config import EgoRunConfig
from giveway.config.option import LANE
from giveway.ego.rules.junctions import PathJunction, junctions_on
from giveway.ego.rules.speed_profile import SpeedProfile, profile_of
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.sumo.network.lane_path import LanePath
from giveway.sumo.session import SumoSession
from giveway.sumo.signal_plans import ChangeOf, untold

_BEHIND = 0.5  # additional distance [m] to a standing vehicle, beyond the distance kept to it
_LEAST_GAP = 1.0  # least distance [m] to a standing vehicle


class Stop(NamedTuple):
    """A scheduled stop: the stations at which the front bumper may halt, and the times."""

    start: float  # station [m] from which on a halt counts
    end: float  # station [m] that the ego drives up to
    duration: float  # time [s] after the arrival, at least
    until: float  # time [s] on SUMO's clock, at least; -inf: not given


@dataclass(frozen=True)
class RouteContext:
    """The context that the rules of one ego are made from.

    Attributes:
        ego: Ego before its departure.
        session: Running simulation, for the network and the signal plans.
        path: Path of the ego.
        lane_path: Lanes that the path was made of: limits, signals, edges, passages.
        departure: Station [m] of the front bumper at which the ego enters.
        shape: Length and width of its body [m].
        time_step: Control step of the co-simulation [s].
        capable: Highest speed [m/s] of the vehicle; inf if it is unknown.
        stops: Scheduled stops that the ego serves, in the path's order.
    """

    ego: WaitingEgo
    session: SumoSession
    path: EgoPath
    lane_path: LanePath
    departure: float
    shape: VehicleShape
    time_step: float
    capable: float = inf
    stops: Sequence[Stop] = ()

    @property
    def config(self) -> EgoRunConfig:
        """The configuration of the ego."""
        return self.ego.config

    @property
    def time(self) -> float:
        """SUMO's clock [s]."""
        return self.session.time

    def heeds(self, rule: str) -> bool:
        """Return whether the ego heeds the rule of this name, by ``[rules]`` or by default."""
        return self.config.heeds(rule)

    @property
    def hardest_braking(self) -> float:
        """The deceleration [m/s^2] that the vehicle is capable of."""
        return self.config.vehicle.acceleration_limit

    @property
    def standing_gap(self) -> float:
        """The gap [m] that the ego needs to a standing vehicle ahead so as to keep places clear."""
        kept = min(self.config.regulation.safe_distance, VEHICLE_GAP)
        return max(_LEAST_GAP, kept + _BEHIND)

    @property
    def change_of(self) -> ChangeOf:
        """The function that returns the next change of a traffic light, as far as it is known."""
        return self.session.signal_plans.change if self.heeds("signal_plans") else untold

    @cached_property
    def profile(self) -> SpeedProfile | None:
        """The speed of a free ego along its path, or None if it is the same everywhere.

        Raises:
            ScenarioError: there are no lanes along the path.
        """
        if not self.heeds("speed_limits"):
            return None
        wanted = self.config.reference_speed
        capable = self.capable if wanted == LANE else min(self.capable, wanted)
        return profile_of(
            self.ego,
            self.path,
            self.lane_path.limits,
            self.departure,
            self.shape.length,
            capable,
            self.time_step,
        )

    @property
    def fastest(self) -> float:
        """The highest speed [m/s] at which the ego wants to drive."""
        return float(self.config.reference_speed) if self.profile is None else self.profile.fastest

    @property
    def desired_speed(self) -> Callable[[float], float]:
        """The speed [m/s] of a free ego by the station [m] of its front bumper."""
        profile = self.profile
        if profile is None:
            wanted = float(self.config.reference_speed)
            return lambda _: wanted
        return profile.at

    @cached_property
    def junctions(self) -> tuple[PathJunction, ...]:
        """The junctions on the path at which vehicles may meet."""
        session, passages = self.session, self.lane_path.passages
        return junctions_on(self.path, passages, self.shape.width, session.junctions, session.lanes)

    def stretches(self, edge: str) -> list[tuple[float, float]]:
        """The intervals of stations [m] in which the path follows an edge, one for each visit.

        Args:
            edge: SUMO's id of the edge.
        """
        begins = self.lane_path.edges
        ends = (*begins[1:], self.path.length)
        lanes = [leave.rpartition("_")[0] for _, leave in self.lane_path.lanes]
        found = zip(lanes, begins, ends, strict=True)
        return [(begin, end) for name, begin, end in found if name == edge]

    @cached_property
    def times_ahead(self) -> Array:
        """The times (N,) [s] from now on of the steps that the ego looks ahead."""
        return self.time_step * np.arange(1.0, self.ego.horizon + 1.0)
