"""FMUs that fail on the road: the vehicle says which, where and when, and can go on afterwards.

Each is the shipped FMU with one line of its C source replaced, compiled for this platform.
"""

from __future__ import annotations

import pytest

from fmus import (
    FmuOutputError,
    FmuPlatformError,
    FmuStartError,
    FmuStateError,
    FmuStepError,
    VehicleFmu,
)
from fmus.sources.fmu_files import FRONT_ENDS

H = 0.05  # [s]


def test_an_output_that_is_no_number_is_named_with_its_time(rebuilt):
    path = rebuilt(
        "instance.c",
        "    self->now.state = next;",
        "    self->now.state = next; if (time > 0.12) self->now.state.speed = NAN;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for _ in range(3):
            vehicle.step(0.0)
        with pytest.raises(FmuOutputError, match=r"edited\.fmu: speed = nan at 0\.2 s; "):
            vehicle.step(0.0)
        with pytest.raises(FmuStateError, match=r"failed at 0\.2 s"):
            vehicle.step(0.0)
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        assert (vehicle.time, vehicle.position) == (H, H)


@pytest.mark.parametrize("quantity", ["position", "speed"])
def test_a_motion_that_no_car_has_is_named_with_its_time(rebuilt, quantity):
    path = rebuilt(
        "instance.c",
        "    self->now.state = next;",
        f"    self->now.state = next; if (time > 0.12) self->now.state.{quantity} = 1e300;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for _ in range(3):
            vehicle.step(0.0)
        with pytest.raises(FmuOutputError, match=rf"{quantity} = 1e\+300 m.* at 0\.2 s"):
            vehicle.step(0.0)


@pytest.mark.parametrize("status", ["DISCARD", "ERROR", "FATAL"])
def test_a_failed_step_is_reported_in_the_fmus_own_words(rebuilt, status):
    path = rebuilt(
        "instance.c",
        "    self->now.state = next;",
        '    if (time > 0.09) { instance_error(self, "the %s broke, 100%% sure", "axle");'
        f" return STATUS_{status}; }}\n    self->now.state = next;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        vehicle.step(0.0)
        with pytest.raises(FmuStepError) as caught:
            vehicle.step(250.0)
    assert str(caught.value).startswith(
        f"{path}: no step from 0.1 s to 0.15 s under 250 N: the FMU returned '{status.lower()}', "
        "the axle broke, 100% sure"
    )


def test_a_warning_does_not_stop_the_vehicle(rebuilt):
    path = rebuilt("instance.c", "    self->now.time = time + dt;\n    return STATUS_OK;",
                   "    self->now.time = time + dt;\n    return STATUS_WARNING;")  # fmt: skip
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        vehicle.step(0.0)
        assert vehicle.position == H


def test_a_start_that_gives_no_number_is_refused(rebuilt):
    path = rebuilt("plant.c", ".acceleration = 0.0}", ".acceleration = 0.0 / p->s0}")
    with VehicleFmu(path, step_size=H) as vehicle:
        with pytest.raises(FmuOutputError, match=r"acceleration = -?nan at 0 s"):
            vehicle.start()
        vehicle.start(position=1.0)
        vehicle.step(0.0)


def test_an_fmu_without_an_instance_is_refused_even_if_silent(rebuilt):
    path = rebuilt("instance.c", "    if (self->name == NULL) return false;", "    return false;")
    with (
        VehicleFmu(path, step_size=H) as vehicle,
        pytest.raises(FmuStartError, match="does not start"),
    ):
        vehicle.start()


def test_a_binary_without_the_standards_functions_is_refused(rebuilt, fmi_version):
    name = f"fmi{fmi_version[0]}Terminate"
    path = rebuilt(FRONT_ENDS[fmi_version], f"Status {name}(", f"Status not_{name}(")
    with pytest.raises(FmuPlatformError, match=f"no function {name}"):
        VehicleFmu(path, step_size=H)


def test_the_time_given_to_the_fmu_is_exact_too(rebuilt):
    """An FMU that insists on k h to the last bit: a running sum fails it within a few steps."""
    path = rebuilt(
        "instance.c",
        "    self->now.state = next;",
        "    self->now.state = next; self->now.state.acceleration = time;",
    )
    with VehicleFmu(path, step_size=H) as vehicle:
        vehicle.start(speed=1.0)
        for k in range(25_000):
            vehicle.step(0.0)
            assert vehicle.acceleration == k * H
