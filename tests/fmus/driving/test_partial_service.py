"""FMUs and hosts that offer less than everything: what they lack is said, the rest works.

Where it takes another FMU, it is the shipped one with a piece of its C source replaced, compiled
for this platform.
"""

from __future__ import annotations

import pytest

import fmus
from fmus import VehicleFmu

H = 0.05  # [s]


@pytest.mark.parametrize("fmi_version", ["3.0"], indirect=True)
def test_an_early_return_that_reached_the_end_is_a_step(rebuilt):
    path = rebuilt("fmi3.c", "*earlyReturn = fmi3False;", "*earlyReturn = fmi3True;")
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        assert vehicle.position == H


@pytest.mark.parametrize("fmi_version", ["3.0"], indirect=True)
def test_an_fmu_that_ends_the_simulation(rebuilt):
    path = rebuilt(
        "fmi3.c", "*terminateSimulation = fmi3False;", "*terminateSimulation = fmi3True;"
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        with pytest.raises(fmus.FmuStepError, match="0 s"):
            vehicle.step(0.0)


def test_outputs_that_cannot_be_read(rebuilt):
    line = "case SPEED: *value = current_state(self).speed; return STATUS_OK;"
    fault = 'case SPEED: return instance_error(self, "no %s today", "speed");'
    path = rebuilt("instance.c", line, fault)
    with VehicleFmu(path, step_size=H) as vehicle, pytest.raises(fmus.FmuError, match="no speed"):
        vehicle.start(speed=1.0)


def test_an_fmu_that_fails_to_save_its_state_after_all(rebuilt):
    line = "    **saved = self->now;\n"
    path = rebuilt("instance.c", line, f'{line}    return instance_error(self, "none today");\n')
    # A foreign FMU: its state is kept at every step.
    with VehicleFmu(path, step_size=H, start_values={"alpha": 0.0}) as vehicle:
        vehicle.start(speed=1.0)
        for k in range(1, 4):
            vehicle.step(0.0)
            assert vehicle.position == k * H


def of_one_step(zoo, only: float) -> VehicleFmu:
    """A car that does steps of one length only, whose profile does not name it."""
    car = zoo.car(
        only_step=only, step=only, flags={"canHandleVariableCommunicationStepSize": "false"}
    )
    values = zoo.profile(car)
    values.get("fmu", {}).pop("step", None)
    return VehicleFmu(car, step_size=0.05, profile=fmus.make_profile(values, "test"))


@pytest.mark.parametrize("only", [0.1, 0.03, 0.02])
def test_the_one_step_of_the_default_experiment_is_done(zoo, only):
    with of_one_step(zoo, only) as vehicle:
        vehicle.start()
        for _ in range(4):
            vehicle.step(100.0)
        assert vehicle.time == 0.2
        assert vehicle.speed > 0.0
