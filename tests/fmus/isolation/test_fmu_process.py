"""FMUs that take their process with them: one line says of what, and when."""

from __future__ import annotations

import re

import pytest

from fmus.errors import FmuCrashError, FmuStateError

STEP_OF_THE_FAULT = r"in the step from 0\.2 s to 0\.25 s under 600 N"


def drive(vehicle, steps=10):
    vehicle.start(speed=1.0)
    for _ in range(steps):
        vehicle.step(600.0)


@pytest.mark.parametrize(
    ("behaviour", "cause"),
    [
        ("segfault", r"died of a segmentation fault \(SIGSEGV: .*\)"),
        ("stack_overflow", r"died of a segmentation fault \(SIGSEGV: .* stack overflowed\)"),
        ("abort", r"died of abort \(SIGABRT: .*\)"),
        ("exit_0", r"ended itself: exit\(0\) was called"),
        ("exit_3", r"ended itself: exit\(3\) was called"),
        ("quick_exit", r"ended itself: exit\(4\) was called"),
        ("kill_self", "died of SIGKILL"),
        ("trap_inexact", r"died of an arithmetic trap \(SIGFPE: .*\)"),
    ],
)
def test_a_death_in_a_step_is_told_with_its_cause_and_time(isolated, behaviour, cause):
    vehicle = isolated(behaviour=behaviour)
    with pytest.raises(FmuCrashError) as caught:
        drive(vehicle)
    line = str(caught.value)
    assert re.fullmatch(
        rf"{re.escape(str(vehicle.path))}: the FMU's process {cause} {STEP_OF_THE_FAULT}; "
        "report it to the FMU's maker",
        line,
    )
    assert vehicle.time == pytest.approx(0.2)
    assert vehicle.speed > 1.0  # as of the last good step
    with pytest.raises(FmuStateError, match=r"failed at 0\.2 s; start it again"):
        vehicle.step(0.0)


@pytest.mark.parametrize("behaviour", ["hang", "sleep_forever", "stop_self"])
def test_a_step_without_an_answer_ends_after_the_time_out(isolated, behaviour):
    vehicle = isolated(behaviour=behaviour, step_timeout=0.5)
    with pytest.raises(FmuCrashError) as caught:
        drive(vehicle)
    assert re.fullmatch(
        rf"{re.escape(str(vehicle.path))}: no answer within 0\.5 s {STEP_OF_THE_FAULT}; killed; if "
        r"it is only slow, add `step_timeout = 5` to \[fmu\] of the profile",
        str(caught.value),
    )


@pytest.mark.parametrize(
    ("phase", "behaviour", "line"),
    [
        (
            "load",
            "segfault",
            "died of a segmentation fault .* while it was loaded; report",
        ),
        ("instantiate", "exit_0", r"ended itself: exit\(0\) was called while it was started; rep"),
        (
            "initialise",
            "hang",
            "no answer within 1 s while .* started; killed; .*start_timeout = 1",
        ),
    ],
)
def test_a_start_can_fail_as_well(isolated, phase, behaviour, line):
    vehicle = isolated(behaviour=behaviour, phase=phase, at=0.0, start_timeout=1.0)
    with pytest.raises(FmuCrashError, match=line):
        vehicle.start()
    with pytest.raises(FmuStateError, match="start it again"):
        vehicle.step(0.0)


def test_the_last_words_are_repeated_on_one_printable_line(isolated):
    vehicle = isolated(behaviour="last_words")
    with pytest.raises(FmuCrashError, match="after printing '") as caught:
        drive(vehicle)
    assert str(caught.value).isprintable()


def test_a_thread_that_crashes_ends_the_process_at_some_step(isolated):
    vehicle = isolated(behaviour="thread_crash")
    with pytest.raises(FmuCrashError, match="segmentation fault"):
        drive(vehicle, 100_000)


@pytest.mark.parametrize("phase", ["terminate", "free"])
def test_a_death_at_the_end_is_a_warning(isolated, phase):
    vehicle = isolated(behaviour="segfault", phase=phase, at=0.0)
    drive(vehicle)
    vehicle.close()
    assert [w.split(":")[0] for w in vehicle.warnings] == [vehicle.path.name]
    assert vehicle.warnings[0].endswith("when it was ended")
    assert vehicle.time == 0.5


def test_after_a_crash_the_vehicle_starts_again_in_a_new_process(isolated):
    vehicle = isolated(behaviour="segfault")
    ends = []
    for _ in range(2):
        with pytest.raises(FmuCrashError):
            drive(vehicle)
        ends.append((vehicle.time, vehicle.position, vehicle.speed))
    assert ends[0] == ends[1]


def test_other_vehicles_drive_on(isolated):
    bad, good = isolated(behaviour="segfault"), isolated()
    good.start(speed=1.0)
    good.step(100.0)
    with pytest.raises(FmuCrashError):
        drive(bad)
    good.step(100.0)
    assert good.time == 0.1
