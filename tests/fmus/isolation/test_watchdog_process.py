"""A watchdog that serves one vehicle after another: each finds it as new; none is left."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import pytest

from fmus import FmuCrashError, processes_reused

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has watchdogs")


def watchdog_of(vehicle):
    return vehicle._process._host._watchdog.process.pid


def drive_on(vehicle):
    for _ in range(1000):
        vehicle.step(0.0)


def drive(vehicle):
    """The watchdog of a vehicle that has driven, and where it got."""
    vehicle.start(speed=1.0)
    for _ in range(5):
        vehicle.step(300.0)
    return watchdog_of(vehicle), vehicle.position


def test_within_a_block_it_serves_the_next_vehicle_then_ends(isolated, nothing_left):
    with processes_reused():
        with isolated() as first:
            one = drive(first)
        assert not list(nothing_left.iterdir())
        with processes_reused(), isolated(behaviour="litter", at=0.0) as second:  # a block within
            assert watchdog_of(second) == one[0]
            second.start()
            second.step(0.0)
            (litter,) = nothing_left.rglob("litter.txt")
            assert litter.parent.name == "scratch"
        assert not list(nothing_left.iterdir())
        with isolated() as third, isolated() as fourth:
            assert drive(third) == one
            pid, position = drive(fourth)
            assert position == one[1]
            assert pid != one[0]
    with isolated() as later:
        assert watchdog_of(later) not in {one[0], pid}
    assert not Path(f"/proc/{one[0]}").exists()


def test_what_an_fmu_prints_last_is_still_told(isolated):
    with processes_reused():
        with isolated() as first:
            pid, _ = drive(first)
        with isolated(behaviour="exit_0") as second:
            assert watchdog_of(second) == pid
            second.start()
            with pytest.raises(FmuCrashError, match=r"exit\(0\) was called"):
                drive_on(second)


@pytest.mark.parametrize("behaviour", ["segfault", "exit_0"])
def test_that_of_an_fmu_which_crashed_is_not_kept(isolated, behaviour):
    with processes_reused():
        with isolated(behaviour=behaviour) as first:
            pid = watchdog_of(first)
            first.start()
            with pytest.raises(FmuCrashError):
                drive_on(first)
        with isolated() as second:
            assert drive(second)[0] != pid
    assert not Path(f"/proc/{pid}").exists()


def test_one_that_is_killed_while_it_waits_is_replaced(isolated):
    with processes_reused():
        with isolated() as first:
            pid, position = drive(first)
        os.kill(pid, signal.SIGKILL)
        with isolated() as second:
            assert drive(second)[1] == position


def test_one_that_is_stopped_while_it_waits_goes_on(isolated):
    with processes_reused():
        with isolated() as first:
            pid, position = drive(first)
        os.kill(pid, signal.SIGSTOP)
        with isolated() as second:
            assert drive(second) == (pid, position)


def test_another_environment_needs_another_one(isolated, monkeypatch):
    with processes_reused():
        with isolated() as first:
            pid, _ = drive(first)
        with monkeypatch.context() as changed:
            changed.setenv("LICENCE_OF_SOME_FMU", "here")
            with isolated() as second:
                assert watchdog_of(second) != pid


def test_a_fork_of_this_process_takes_none_of_its_watchdogs(isolated):
    with processes_reused():
        with isolated() as first:
            pid, position = drive(first)
        child = os.fork()
        if child == 0:
            code = 1
            try:
                with isolated() as vehicle:
                    code = 2 if watchdog_of(vehicle) == pid else 3
                    if drive(vehicle)[1] == position and code == 3:
                        code = 0
            finally:
                os._exit(code)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        with isolated() as second:
            assert drive(second) == (pid, position)
