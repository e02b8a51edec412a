"""What a fit loses: a car that people no longer heed."""

from __future__ import annotations

from dataclasses import replace

from giveway.validation.behaviour.loss import lost
from pedestrian_model import SIM


def test_a_car_that_is_no_longer_heeded_is_told() -> None:
    ahead, beside = lost(SIM, replace(SIM, vehicle_strength=100.0))
    assert ahead.startswith("A car at 3 m/s pushes people 2 m ahead of it with ")
    assert "1 m beside it" in beside


def test_a_change_that_keeps_half_of_the_force_is_none() -> None:
    assert lost(SIM, SIM) == []
    assert lost(SIM, replace(SIM, vehicle_strength=0.6 * SIM.vehicle_strength)) == []
