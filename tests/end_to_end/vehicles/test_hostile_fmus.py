"""Whatever an FMU does in its process, ours gets one clear line, or a drive that is right."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path

import psutil
import pytest

from fmus import FmuOutputError, FmuStepError, processes_reused
from fmus.errors import FmuCrashError, FmuError, FmuStartError

H = 0.05  # [s]
AT = 0.2  # [s] when the fault begins
KINDS = {
    "fmi1": {"fmi": "1.0"},
    "fmi2": {"fmi": "2.0"},
    "fmi3": {"fmi": "3.0"},
    "fmi2_me": {"fmi": "2.0", "kind": "model-exchange"},
    "fmi3_me": {"fmi": "3.0", "kind": "model-exchange"},
}

# Fault: the error and what its one line has to say, besides the file.
DEATHS = {
    "segfault": r"SIGSEGV",
    "abort": r"SIGABRT",
    "last_words": r"SIGABRT.*assertion failed: .*wheels == 4",
    "stack_overflow": r"SIGSEGV",
    "exit_0": r"exit\(0\)",
    "exit_3": r"exit\(3\)",
    "quick_exit": r"exit\(4\)",
    "kill_self": r"SIGKILL",
    "trap_inexact": r"SIGFPE",  # its own arithmetic walks into the trap
    "hang": r"no answer within 1 s",
    "sleep_forever": r"no answer within 1 s",
    "stop_self": r"no answer within 1 s",
}
REFUSALS = {
    "error": r"'error', the axle broke",
    "fatal": r"'fatal', the engine is on fire",
    "pending": r"pending",
    "unknown_status": r"77",
    "discard_always": r"discard",
    "discard_creeping": r"discard",
    "discard_backwards": r"discard",
    "discard_nan": r"discard",
    "terminate": r"end|the tank is empty",
}
NONSENSE = {
    "nan": r"speed = nan",
    "nan_position": r"position = nan",
    "nan_acceleration": r"acceleration = nan",
    "inf": r"speed = inf",
    "huge": r"speed = 1e\+300",
    "jump": r"position = 50\.\d* m",
}
HARMLESS = {
    "warning": ["warning"],
    "discard_once": ["discard_once"],
    "discard_long": ["discard_long"],
    "discard_spoiled": ["discard_spoiled"],
    "memory": ["memory"],
    "messages": [
        "message_latin1", "message_null", "message_percent", "message_arguments",
        "message_control", "message_huge", "message_thread",
    ],
    "floods": ["flood_log", "flood_stdout", "flood_stderr"],
    "its process's settings": ["chdir", "setlocale", "environment", "umask"],
    "litter": ["litter"],
    "trap_floats": ["trap_floats"],
    "signals": ["ignore_signals", "replace_handlers"],
    "processes and threads": ["fork_child", "fork_session", "thread"],
    "close_files": ["close_files"],
    "write_into_files": ["write_into_files"],
}  # fmt: skip


@pytest.fixture(scope="module")
def own_temp(tmp_path_factory):
    """A folder for temporary files of one watchdog, which serves all sound FMUs in turn."""
    before = set(psutil.Process().children(recursive=True))
    folder = tmp_path_factory.mktemp("temp")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMPDIR", str(folder))
        patch.setattr(tempfile, "tempdir", str(folder))
        with processes_reused():
            yield folder
    assert set(psutil.Process().children(recursive=True)) <= before
    assert not list(folder.iterdir())


@pytest.fixture(autouse=True)
def nothing_left(own_temp):
    """No process, no temporary folder, and this process as it was."""

    def state():
        mask = os.umask(0o022)
        os.umask(mask)
        # pytest itself writes the name of the present test into the environment
        return Path.cwd(), mask, {k: v for k, v in os.environ.items() if "PYTEST" not in k}

    before = state()
    yield
    assert state() == before
    assert not list(own_temp.iterdir())


def drive(vehicle) -> None:
    vehicle.start(speed=1.0)
    for _ in range(10):
        vehicle.step(100.0)


def failure(vehicle, path) -> FmuError:
    """What a drive ends with: one printable line that begins with the file."""
    with pytest.raises(FmuError) as caught:
        drive(vehicle)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert text.isprintable()
    assert len(text) < 600
    children = psutil.Process().children(recursive=True)
    vehicle.close()
    assert [p for p in children if p.is_running() and p.status() == psutil.STATUS_ZOMBIE] == []
    return caught.value


def patience(says: str) -> float:
    """Time to wait for an answer [s], short where none will come."""
    return 1.0 if "no answer" in says else 60.0


def in_turn(faults, *kinds):
    """Each fault in an FMU of another kind: kind and fault are dealt with by different code."""
    return [(fault, kinds[i % len(kinds)]) for i, fault in enumerate(faults)]


@pytest.mark.parametrize(("fault", "kind"), in_turn(DEATHS, "fmi1", "fmi3_me"))  # FMI 2: tests/fmus
def test_an_fmu_that_dies_or_hangs_ends_at_its_step(zoo, isolated, fault, kind):
    # the derivatives at the end of a step are asked for within it
    path = zoo.car(**KINDS[kind], behaviour=fault, at=AT + 0.01 * kind.endswith("me"))
    vehicle = isolated(path, step_timeout=patience(DEATHS[fault]))
    error = failure(vehicle, path)
    assert isinstance(error, FmuCrashError)
    assert vehicle.time == pytest.approx(AT)
    assert_says(error, DEATHS[fault])
    assert_says(error, r"0\.2 s")


@pytest.mark.parametrize("kind", ["fmi1", "fmi2", "fmi3"])
@pytest.mark.parametrize("fault", REFUSALS)
def test_an_fmu_that_refuses_a_step_ends_there(zoo, isolated, fault, kind):
    path = zoo.car(**KINDS[kind], behaviour=fault, at=AT)
    vehicle = isolated(path)
    error = failure(vehicle, path)
    assert isinstance(error, FmuStepError)
    assert_says(error, REFUSALS[fault])
    assert_says(error, r"0\.2 s to 0\.25 s")
    assert vehicle.time == pytest.approx(AT)


@pytest.mark.parametrize(("fault", "kind"), in_turn(NONSENSE, "fmi1", "fmi3", "fmi2_me"))
def test_nonsense_is_named_with_variable_and_time(zoo, isolated, fault, kind):
    path = zoo.car(**KINDS[kind], behaviour=fault, at=AT)
    error = failure(isolated(path), path)
    assert isinstance(error, FmuOutputError)
    assert_says(error, NONSENSE[fault])
    assert_says(error, r"at 0\.25? s")


@pytest.fixture
def driven(zoo, isolated):
    """Where a car with a behaviour comes to."""

    def come_to(behaviour):
        vehicle = isolated(zoo.car(behaviour=behaviour, at=AT))
        drive(vehicle)
        vehicle.close()
        return vehicle.position, vehicle.speed, vehicle.acceleration

    return come_to


USUAL = []  # where the car without a fault comes to, driven once


@pytest.mark.parametrize("fault", HARMLESS)
def test_what_does_no_harm_changes_no_digit(driven, fault):
    if not USUAL:
        USUAL.append(driven(()))
    tolerance = 1e-12 if fault.startswith("discard") else 0.0  # other sub-steps round otherwise
    assert driven(HARMLESS[fault]) == pytest.approx(USUAL[0], rel=0, abs=tolerance)


AT_START = {
    ("segfault", "load"): "SIGSEGV",
    ("hang", "load"): r"no answer within 1 s",
    ("exit_0", "instantiate"): r"exit\(0\)",
    ("sleep_forever", "instantiate"): r"no answer within 1 s",
    ("silent_null", "instantiate"): "Instantiate",
    ("error", "instantiate"): "the axle broke",
    ("abort", "initialise"): "SIGABRT",
    ("sleep_forever", "initialise"): r"no answer within 1 s",
    ("error", "initialise"): "the axle broke",
    ("fatal", "initialise"): "engine is on fire",
    ("refuse_start_value", "initialise"): "I do not like this start value",
}


@pytest.mark.parametrize(("case", "fmi"), in_turn(AT_START, "1.0", "2.0", "3.0"))
def test_an_fmu_that_fails_at_the_start_says_so(zoo, isolated, case, fmi):
    (fault, phase), says = case, AT_START[case]
    path = zoo.car(fmi=fmi, behaviour=fault, phase=phase, at=0.0)
    error = failure(isolated(path, start_timeout=patience(says)), path)
    assert isinstance(error, FmuStartError | FmuCrashError)
    assert_says(error, says)


@pytest.mark.parametrize("phase", ["terminate", "free", "unload"])
@pytest.mark.parametrize("fault", ["segfault", "exit_0", "hang", "fatal"])
def test_what_happens_at_the_end_no_longer_matters(zoo, isolated, fault, phase, monkeypatch):
    monkeypatch.setattr("fmus.isolation.fmu_process._END_TIMEOUT", 0.3)
    if (fault, phase) == ("fatal", "unload"):
        pytest.skip("nobody asks for a status then")
    vehicle = isolated(zoo.car(behaviour=fault, phase=phase, at=0.0))
    vehicle.start(speed=1.0)
    vehicle.step(0.0)
    assert vehicle.time == H
    vehicle.close()


def test_the_next_vehicle_works(zoo, isolated):
    path = zoo.car(behaviour="segfault", at=AT)
    failure(isolated(path), path)
    vehicle = isolated(zoo.car())
    vehicle.start(speed=1.0)
    vehicle.step(0.0)
    assert vehicle.time == H


def assert_says(error: Exception, pattern: str) -> None:
    assert re.search(pattern, str(error)), error
