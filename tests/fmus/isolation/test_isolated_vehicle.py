"""What an FMU does to its process stays there, and does not stop the vehicle."""

from __future__ import annotations

import os
import threading

import pytest

from fmus import FmuError, VehicleFmu, bundled_fmu, open_vehicle
from fmus.isolation import IsolatedVehicle
from fmus.profile.vehicle_profile import make_profile

STEP = 0.05  # [s]

HARMLESS = {
    "process": ["chdir", "litter", "setlocale", "environment", "umask", "memory"],
    "signals": ["ignore_signals", "replace_handlers", "kill_parent"],
    "files": ["close_files", "write_into_files"],
    "floats": ["trap_floats", "round_up"],
    "offspring": ["fork_child", "fork_session", "thread"],
    "output": ["flood_stdout", "flood_stderr", "flood_log"],
    "messages": ["message_null", "message_latin1", "message_huge", "message_control"],
}


def motion(vehicle, steps=8):
    vehicle.start(position=3.0, speed=1.0)
    rows = []
    for _ in range(steps):
        vehicle.step(600.0)
        rows.append((vehicle.time, vehicle.position, vehicle.speed, vehicle.acceleration))
    return rows


@pytest.fixture(scope="module")
def reference(zoo):
    """The motion of a car that does nothing wrong."""
    path = zoo.car()
    profile = make_profile(zoo.profile(path), "the zoo's profile")
    with VehicleFmu(path, step_size=STEP, profile=profile) as vehicle:
        return motion(vehicle)


@pytest.mark.parametrize("group", HARMLESS)
def test_the_vehicle_drives_on_and_the_host_is_as_before(isolated, reference, group):
    vehicle = isolated(behaviour=HARMLESS[group])
    rows = motion(vehicle)
    assert len(rows) == len(reference)
    for row, expected in zip(rows, reference, strict=True):
        assert row == pytest.approx(expected, rel=1e-14)  # it may round as it likes


@pytest.mark.parametrize("behaviour", ["error", "fatal", "pending", "nan", "inf", "huge", "jump"])
def test_other_failures_are_told_as_in_this_process(isolated, zoo, behaviour):
    vehicle = isolated(behaviour=behaviour)
    profile = make_profile(zoo.profile(vehicle.path), "the zoo's profile")
    ends = []
    with VehicleFmu(vehicle.path, step_size=STEP, profile=profile) as here:
        for each in (here, vehicle):
            with pytest.raises(FmuError) as caught:
                motion(each)
            state = each.time, repr((each.position, each.speed)), each.acceleration
            ends.append((type(caught.value), str(caught.value), *state))
    assert ends[0] == ends[1]


def test_warnings_come_across(isolated):
    vehicle = isolated(behaviour="frozen", at=0.0)
    vehicle.start()
    for _ in range(60):
        vehicle.step(600.0)
    assert len(vehicle.warnings) == 1
    assert vehicle.warnings[0].startswith(f"{vehicle.path.name}: ")


def test_ctrl_c_in_a_step_spoils_nothing_but_the_episode(isolated):
    vehicle = isolated(behaviour="sleep_forever")
    vehicle.start()
    threading.Timer(0.5, os.kill, (os.getpid(), 2)).start()
    with pytest.raises(KeyboardInterrupt):
        motion(vehicle)
    assert vehicle.time == pytest.approx(0.2)
    with pytest.raises(FmuError, match="failed at"):
        vehicle.step(0.0)
    motion(vehicle, steps=3)
    assert not vehicle.warnings  # the sleeping process was not asked to end, but killed


def test_vehicles_in_several_threads_do_not_mix(isolated, reference):
    vehicles = [isolated() for _ in range(2)]
    results = {}
    threads = [
        threading.Thread(target=lambda n=n: results.update({n: motion(vehicles[n])}))
        for n in range(2)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == {0: reference, 1: reference}


def test_ours_runs_here_and_any_other_in_its_own_process(zoo, nothing_left):
    path = zoo.car()
    profile = make_profile(zoo.profile(path), "the zoo's profile")
    with open_vehicle(bundled_fmu(), step_size=STEP) as ours:
        assert isinstance(ours, VehicleFmu)
    with open_vehicle(path, step_size=STEP, profile=profile) as theirs:
        assert isinstance(theirs, IsolatedVehicle)
    with open_vehicle(path, step_size=STEP, profile=profile, isolated=False) as trusted:
        assert isinstance(trusted, VehicleFmu)
