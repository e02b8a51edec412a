"""What the tests of the rules tell a rule, and ask it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.ego.rules.protocol import Demand, Situation
from pedestrian_model import Crowd

NOBODY = Crowd.empty()


def tell(rule: Any, station: float, speed: float, time: float = 0.0, **told: Mapping[Any, Any]):
    """Tell a rule of signals, traffic and merging vehicles, as after a step of SUMO's."""
    rule.update(Situation(time, station, speed, **told))


def demand_of(
    rule: Any, station: float, speed: float, crowd: Crowd = NOBODY, leader: Leader = NO_LEADER
) -> Demand:
    """What a rule demands; nothing but infinities if it demands nothing."""
    return rule.demand(Situation(0.0, station, speed, crowd, leader)) or Demand()


def stop_of(
    rule: Any, station: float, speed: float, crowd: Crowd = NOBODY, leader: Leader = NO_LEADER
) -> float:
    """The station [m] at which a rule demands a stop; inf: nowhere."""
    return demand_of(rule, station, speed, crowd, leader).stop
