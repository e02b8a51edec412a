"""The start of an instance: when its inputs are set, and its first time."""

from __future__ import annotations

from math import exp

import pytest

from fmus import FmuStartError

BOTH = [("2.0", "co-simulation"), ("2.0", "model-exchange"), ("3.0", "both")]


@pytest.mark.parametrize(("fmi", "kind"), BOTH)
def test_inputs_count_as_initialization_mode_is_entered(zoo, open_car, fmi, kind):
    path = zoo.car(fmi=fmi, kind=kind, extra=("spare_input",), divides=True)
    with pytest.raises(FmuStartError, match="spare_input is 0: division by zero"):
        open_car(path).start()
    for one in ("co-simulation", "model-exchange") if kind == "both" else (kind,):
        car = open_car(path, parameters={"spare_input": 3.9}, fmu={"kind": one})
        car.start(speed=4.0)
        car.step(500.0)
        assert car.speed > 4.0


@pytest.mark.parametrize(("fmi", "kind"), [("1.0", "co-simulation"), *BOTH])
def test_an_fmu_starts_at_its_own_time(zoo, open_car, fmi, kind):
    shift = {"gear_time": 5.1, "gear_ratio": 0.5}  # half the force from 5.1 s on
    car = open_car(zoo.car(fmi=fmi, kind=kind, values=shift), fmu={"start_time": 5.0})
    car.start(speed=4.0)
    for _ in range(4):
        car.step(1000.0)
    v = 4.0
    for force, steps in ((1000.0, 2), (500.0, 2)):
        for _ in range(steps):  # M v' = F - alpha v, exactly
            end = force / 100.0
            v = end + (v - end) * exp(-0.05 * 100.0 / 1000.0)
    assert car.speed == pytest.approx(v, abs=1e-6)
    assert car.time == pytest.approx(0.2)
