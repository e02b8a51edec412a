"""The protocol of a rule of the road: it gets a `Situation` and returns a `Demand`.

A rule is a class of one file. It is made once for each ego, by a factory that looks at the
`RouteContext`, and asked at each control step. The members of `RULES` and the rules of other
packages (entry points `giveway.rules`) keep to the same protocol; docs/plugins.md is the guide.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from types import MappingProxyType
from typing import NamedTuple, Protocol, runtime_checkable

from giveway.ego.perception.hidden_people import NOWHERE, Hidden
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.junctions import PathJunction, Traffic
from giveway.ego.rules.merge_points import MergePoint, MergingVehicle
from giveway.ego.rules.yielding import at_rest
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

LIGHT, STOP, YIELD = "light", "stop", "yield"
"""The causes of a stop: a red light, a scheduled stop, a road user with priority."""


class Told(NamedTuple):
    """The state of SUMO that an ego's rules need, as declared by their ``Needs``."""

    signals: Mapping[str, str] = MappingProxyType({})  # state of each signal system, by its id
    traffic: Traffic = MappingProxyType({})  # vehicles that approach each junction, by its id
    merging: Mapping[MergePoint, Mapping[str, MergingVehicle]] = MappingProxyType(
        {}
    )  # vehicles at each merge point in sight, by their ids


@dataclass(slots=True)
class Situation:
    """The state that an ego's rules know at one instant: one object per ego, refilled in place."""

    time: float = 0.0  # SUMO's clock [s]
    station: float = 0.0  # station [m] of the front bumper along the path
    speed: float = 0.0  # speed of the ego [m/s]
    crowd: Crowd = field(default_factory=Crowd.empty)  # pedestrians as the ego sees them
    leader: Leader = NO_LEADER  # vehicle ahead, which may be one that merges
    stop_at_light: float = inf  # station [m] of the stop at a red light; inf without one
    signals: Mapping[str, str] = field(
        default_factory=dict
    )  # state of each signal system, one letter per movement
    traffic: Traffic = field(default_factory=dict)  # vehicles that approach each junction
    merging: Mapping[MergePoint, Mapping[str, MergingVehicle]] = field(
        default_factory=dict
    )  # vehicles at each merge point, by their ids
    hidden: Hidden = NOWHERE  # places ahead where people could come out of hiding

    def leader_at_rest(self) -> Leader:
        """The vehicle ahead, placed where it comes to rest if it has to stop at the red light."""
        return at_rest(self.leader, self.stop_at_light)


class Demand(NamedTuple):
    """The demands of one rule at one instant. A field without a demand is infinite or empty."""

    stop: float = inf  # station [m] at which the front bumper has to stop
    cause: str = ""  # reason of the stop, for the column `waits_for`
    latest: float = inf  # station [m] of the front bumper beyond which no plan may lead
    speed: float = inf  # speed [m/s] not to be exceeded now
    advice: float = inf  # speed [m/s] advised to a controller that plans ahead
    leader: Leader = NO_LEADER  # vehicle to be followed as if it were ahead already
    lane_speeds: Array | None = None  # (N,) speeds [m/s] not to be exceeded in the steps ahead


class Needs(NamedTuple):
    """The events that a rule needs to know about. They do not change during the drive."""

    systems: frozenset[str] = frozenset()  # SUMO's ids of signal systems
    junctions: tuple[PathJunction, ...] = ()  # junctions whose traffic matters
    merges: tuple[MergePoint, ...] = ()  # merge points, in the path's order
    keep_clear: tuple[tuple[float, float], ...] = ()  # stations [m] at which no ego may stand


NO_NEEDS = Needs()


@runtime_checkable
class Rule(Protocol):
    """A rule of the road for one ego.

    A rule may also have these members; one that is missing costs nothing:

    * ``needs``: `Needs`, the events that the rule needs to know about;
    * ``update(situation)``: called after each of SUMO's steps, when signals and traffic are new;
    * ``advance(situation, time_step)``: called after each control step of ``time_step`` [s];
    * ``beside``: ids of vehicles that will pass beside the ego's path, on lanes of their own;
    * ``remarks``: sentences for the user about how the drive went.
    """

    def demand(self, situation: Situation, /) -> Demand | None:
        """The demand of the rule at this control step, or None if it demands nothing."""
