"""What a fit loses: a car that people no longer heed."""

from __future__ import annotations

from dataclasses import replace

from giveway.validation.behaviour.loss import lost
from pedestrian_model import SIM


def test_a_car_that_is_no_longer_heeded_is_told() -> None:
    ahead, beside = lost(SIM, replace(SIM, vehicle_strength=10.0))
    assert ahead.startswith("A car at 3 m/s pushes people 2 m ahead of it with ")
    assert "1 m beside it" in beside


def test_a_force_that_still_moves_people_is_not_lost() -> None:
    assert lost(SIM, SIM) == []
    assert lost(SIM, replace(SIM, vehicle_decay=1.0, vehicle_strength=300.0)) == []
    weak = replace(SIM, vehicle_strength=0.1 * SIM.vehicle_strength)
    assert lost(weak, replace(weak, vehicle_strength=0.6 * weak.vehicle_strength)) == []
