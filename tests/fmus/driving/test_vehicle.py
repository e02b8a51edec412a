"""VehicleFmu: exact time, and nothing left behind."""

from __future__ import annotations

import gc
import os
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fmus import FmuError, FmuStateError, VehicleFmu, bundled_fmu, make_profile

H = 0.05  # [s]


def state(vehicle):
    return vehicle.time, vehicle.position, vehicle.speed, vehicle.acceleration


@pytest.fixture
def vehicle(fmu):
    with VehicleFmu(fmu, step_size=H) as vehicle:
        yield vehicle


@pytest.fixture
def temporary_folder(tmp_path, monkeypatch):
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


# ---- starting and stepping ----


def test_it_starts_where_it_is_told(vehicle):
    vehicle.start(position=-12.5, speed=4.0)
    assert state(vehicle) == (0.0, -12.5, 4.0, 0.0)


def test_every_start_is_a_new_beginning(vehicle):
    for _ in range(2):
        vehicle.start(speed=4.0)
        vehicle.step(500.0)
        assert state(vehicle)[:3] == (
            H,
            H * 4.0,
            (1.0 - 100.0 * H / 1000.0) * 4.0 + H / 1000.0 * 500.0,
        )


def test_results_are_plain_floats(vehicle):
    vehicle.start(speed=4.0)
    vehicle.step(np.float64(10.0))
    assert {type(value) for value in state(vehicle)} == {float}


def test_time_is_a_multiple_and_never_a_running_sum(vehicle):
    """A running sum of 0.05 leaves k h after a few steps, and FMUs may refuse it later on."""
    vehicle.start(speed=1.0)
    running_sum = 0.0
    for k in range(1, 25_001):
        vehicle.step(100.0)
        running_sum += H
        assert vehicle.time == k * H
    assert running_sum != vehicle.time


def test_start_values_reach_the_fmu(fmu):
    values = {"M": 2000.0, "alpha": 0.0, "exact": True}
    with VehicleFmu(fmu, step_size=0.5, start_values=values) as vehicle:
        vehicle.start()
        vehicle.step(4000.0)
        assert (vehicle.position, vehicle.speed) == pytest.approx((0.25, 1.0), abs=1e-15)


def test_other_variable_names_can_be_given(remake):
    path = remake(edit=lambda xml: xml.replace('name="speed"', 'name="v_x"'))
    profile = make_profile(
        {
            "inputs": {"force": {"variable": "force"}},
            "outputs": {"speed": {"variable": "v_x"}},
            "initial": {"speed": {"variable": "v0"}},
        },
        "test",
    )
    with VehicleFmu(path, step_size=H, profile=profile) as vehicle:
        vehicle.start(speed=3.0)
        assert vehicle.speed == 3.0


def test_two_vehicles_do_not_know_each_other(fmu):
    with VehicleFmu(fmu, step_size=H) as a, VehicleFmu(fmu, step_size=H) as b:
        a.start(speed=1.0)
        b.start(speed=2.0)
        a.step(0.0)
        assert (a.time, b.time, b.position, b.speed) == (H, 0.0, 0.0, 2.0)
        b.step(0.0)
        assert (a.position, b.position) == (H * 1.0, H * 2.0)


@settings(max_examples=30)
@given(st.lists(st.floats(-8000.0, 8000.0), max_size=60), st.booleans(), st.booleans())
def test_both_fmi_versions_give_the_same_bits(forces, exact, reverse):
    results = []
    for version in ("2.0", "3.0"):
        values = {"exact": exact, "reverse": reverse}
        with VehicleFmu(bundled_fmu(version), step_size=H, start_values=values) as vehicle:
            vehicle.start(position=1.0, speed=4.0)
            results.append([state(vehicle)])
            for force in forces:
                vehicle.step(force)
                results[-1].append(state(vehicle))
    assert results[0] == results[1]


# ---- the end ----


def test_stepping_needs_a_start(vehicle):
    with pytest.raises(FmuStateError, match="start"):
        vehicle.step(0.0)


def test_a_closed_vehicle_says_so(fmu):
    vehicle = VehicleFmu(fmu, step_size=H)
    vehicle.start()
    vehicle.close()
    vehicle.close()
    for call in (lambda: vehicle.step(0.0), vehicle.start):
        with pytest.raises(FmuStateError, match="closed"):
            call()


def test_many_vehicles_leave_no_temporary_folder_behind(fmu, temporary_folder):
    here = Path.cwd()
    for _ in range(100):
        with VehicleFmu(fmu, step_size=H) as vehicle:
            vehicle.start(speed=1.0)
            vehicle.step(0.0)
    assert list(temporary_folder.iterdir()) == []
    assert Path.cwd() == here


def test_an_exception_in_the_run_leaves_nothing_behind(fmu, temporary_folder):
    def run():
        with VehicleFmu(fmu, step_size=H) as vehicle:
            vehicle.start()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run()
    assert list(temporary_folder.iterdir()) == []


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_a_forgotten_vehicle_leaves_nothing_behind(fmu, temporary_folder):
    vehicle = VehicleFmu(fmu, step_size=H)
    vehicle.start()
    assert len(list(temporary_folder.iterdir())) == 1
    del vehicle
    gc.collect()
    assert list(temporary_folder.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="another library format")
def test_a_failed_load_leaves_nothing_behind(remake, temporary_folder):
    here = Path.cwd()
    broken = remake(replace=lambda name: b"\x7fELF?" if name.startswith("binaries/") else None)
    with pytest.raises(FmuError):
        VehicleFmu(broken, step_size=H)
    assert list(temporary_folder.iterdir()) == []
    assert Path.cwd() == here
