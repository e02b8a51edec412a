"""When the controller decides, what counts as decided, and what it refuses."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

    from controller import Observation, SpeedController
    from fmus.sources.parameters import ControllerParameters

    Seen = Callable[..., Observation]
    NewHost = Callable[..., Any]


@pytest.fixture
def defaults() -> ControllerParameters:
    from fmus.sources.parameters import ControllerParameters

    return ControllerParameters()


def test_the_force_depends_on_the_inputs_of_the_same_instant(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=2.0))
    slow = host.get("force")
    host.see(seen(speed=6.0))
    fast = host.get("force")
    assert slow > 0 > fast
    host.see(seen(speed=2.0))
    assert host.get("force") == slow  # reading decides nothing


def test_the_force_is_there_in_initialization_mode(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version, initialised=False)
    if host.is_fmi2:
        host.fmu.setupExperiment(startTime=0.0)
    host.fmu.enterInitializationMode()
    host.see(seen(speed=3.0))
    force = host.get("force")
    host.fmu.exitInitializationMode()
    assert force > 0
    assert host.get("force") == force


def test_outputs_stay_those_of_the_step_until_an_input_is_set(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=3.0))
    first = host.get("force")
    host.step(0.0, 0.05)
    assert host.get("force") == first
    host.see(seen(speed=3.0))
    assert host.get("force") > first  # c2 lets it rise by du_max more


def test_a_step_without_new_inputs_decides_anew(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=3.0))
    forces = []
    for k in range(3):
        host.step(0.05 * k, 0.05)
        forces.append(host.get("force"))
    assert forces == pytest.approx([1000.0, 2000.0, 3000.0], abs=1e-2)  # du_max a step


def test_reading_in_between_changes_nothing(
    fmi_version: str,
    new_host: NewHost,
    regulator_of: Callable[[ControllerParameters], SpeedController],
    defaults: ControllerParameters,
    seen: Seen,
) -> None:
    host, regulator = new_host(fmi_version), regulator_of(defaults)
    for k in range(40):
        for other in (0.0, 9.0):
            host.see(seen(speed=other, obstacle=5.0))
            host.get("acting")
        now = seen(position=0.2 * k, speed=4.0, obstacle=20.0)
        host.see(now)
        assert host.get("force") == pytest.approx(regulator.control(now).force, abs=1e-7)
        host.step(0.05 * k, 0.05)


@pytest.mark.parametrize("parts", [2, 5, 7])
def test_between_two_decisions_the_force_is_held(
    parts: int, fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host, size = new_host(fmi_version), 0.05 / parts
    for k in range(20):
        host.see(seen(speed=3.0 + 0.1 * k))
        decided = host.get("force")
        for i in range(parts):
            host.step((k * parts + i) * size, size)
            if i < parts - 1:
                host.see(seen(speed=12.0, obstacle=3.0))  # is only noted
            assert host.get("force") == decided


def test_variable_steps_may_end_where_a_decision_is_due(
    fmi_version: str, new_host: NewHost
) -> None:
    host = new_host(fmi_version)
    for start, end in [(0.0, 0.01), (0.01, 0.05), (0.05, 0.1), (0.1, 0.1125), (0.1125, 0.15)]:
        host.step(start, end - start)


@pytest.mark.parametrize("size", [0.1, 0.06, 1.0])
def test_a_step_past_a_decision_is_refused_with_the_remedy(
    size: float, fmi_version: str, new_host: NewHost
) -> None:
    host = new_host(fmi_version)
    message = host.refuses(lambda: host.step(0.0, size))
    assert f"to {size:g} s, past the decision that is due at 0.05 s" in message
    assert "expected steps of dt = 0.05 s or a whole fraction" in message


def test_an_incommensurable_step_is_refused_where_it_misses(
    fmi_version: str, new_host: NewHost
) -> None:
    host = new_host(fmi_version)
    host.step(0.0, 0.03)
    assert "past the decision that is due at 0.05 s" in host.refuses(lambda: host.step(0.03, 0.03))


def test_another_time_step_can_be_set(fmi_version: str, new_host: NewHost) -> None:
    host = new_host(fmi_version, dt=0.1)
    host.step(0.0, 0.1)
    host.step(0.1, 0.1)
    assert "due at 0.3 s" in host.refuses(lambda: host.step(0.2, 0.15))


def test_it_decides_every_dt_from_the_start_time_on(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version, initialised=False)
    host.initialise(start_time=100.02)
    for k in range(2000):  # the host's clock is a running sum's worth of rounding away
        host.see(seen(speed=4.0))
        host.step(100.02 + 0.05 * k, 0.05)
    assert host.get("acting") == 1


def test_a_saved_state_is_gone_back_to(fmi_version: str, new_host: NewHost, seen: Seen) -> None:
    host = new_host(fmi_version)
    crowd = [seen(speed=4.0, position=0.2 * k, obstacle=10.0 + 0.1 * k) for k in range(40)]

    def drive(steps: range) -> list[float]:
        forces = []
        for k in steps:
            host.see(crowd[k])
            forces.append(host.get("force"))
            host.step(0.05 * k, 0.05)
        return forces

    drive(range(20))
    kept = host.fmu.getFMUstate() if host.is_fmi2 else host.fmu.getFMUState()
    once = drive(range(20, 40))
    text = serialised(host, kept)
    (host.fmu.setFMUstate if host.is_fmi2 else host.fmu.setFMUState)(kept)
    assert drive(range(20, 40)) == once

    fresh = new_host(fmi_version)
    restore(fresh, text)
    host = fresh
    assert drive(range(20, 40)) == once


def serialised(host: Any, state: Any) -> bytes:
    call = host.fmu.serializeFMUstate if host.is_fmi2 else host.fmu.serializeFMUState
    return bytes(call(state))


def restore(host: Any, text: bytes) -> None:
    if host.is_fmi2:
        host.fmu.setFMUstate(host.fmu.deSerializeFMUstate(text, ctypes.c_void_p()))
    else:
        host.fmu.setFMUState(host.fmu.deserializeFMUState(text))


def test_reset_forgets_everything(fmi_version: str, new_host: NewHost, seen: Seen) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=3.0))
    first = host.get("force")
    host.step(0.0, 0.05)
    host.fmu.reset()
    host.initialise()
    host.see(seen(speed=3.0))
    assert host.get("force") == first


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("M", 0.0, "M = 0 kg: expected a mass above 0"),
        ("dt", -0.05, "dt = -0.05 s: expected a time step above 0"),
        ("v_max", 0.0, "v_max = 0 m/s: expected more than v_min"),
        ("K_p", -1.0, "K_p = -1 N.s/m: expected 0 or more"),
        ("alpha", 30000.0, "alpha dt / M = 1.5: expected 1 or less"),
    ],
)
def test_an_impossible_parameter_is_named(
    name: str, value: float, expected: str, fmi_version: str, new_host: NewHost
) -> None:
    host = new_host(fmi_version, initialised=False, **{name: value})
    assert expected in host.refuses(host.initialise)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_speed_that_is_no_number_is_refused(
    value: float, fmi_version: str, new_host: NewHost
) -> None:
    host = new_host(fmi_version)
    assert f"speed = {value}: expected a number" in host.refuses(lambda: host.set("speed", value))


def test_infinity_and_the_start_value_both_mean_nobody(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=3.0))
    force = host.get("force")
    host.see(seen(speed=3.0, obstacle=float("inf"), limit=float("inf")))
    assert host.get("force") == force


def test_the_horizon_can_be_shortened_at_run_time(
    fmi_version: str,
    new_host: NewHost,
    regulator_of: Callable[[ControllerParameters], SpeedController],
    seen: Seen,
) -> None:
    from fmus.sources.parameters import ControllerParameters

    host = new_host(fmi_version, N=6)
    now = seen(speed=4.0, obstacle=8.9, horizon=6)
    host.see(now)
    regulator = regulator_of(ControllerParameters(horizon=6))
    decision = regulator.control(now)
    assert host.get("N") == 6
    assert host.get("acting") == {"mpc": 1, "pid": 2}[decision.acting]
    assert host.get("force") == pytest.approx(decision.force, abs=1e-7)


def test_the_log_says_who_takes_over_and_why(
    fmi_version: str, new_host: NewHost, seen: Seen
) -> None:
    host = new_host(fmi_version)
    host.see(seen(speed=4.0))
    host.step(0.0, 0.05)
    host.see(seen(speed=4.0, obstacle=5.0))
    host.step(0.05, 0.05)
    assert host.messages[-2:] == [
        "at 0 s: the MPC acts",
        "at 0.05 s: the PID acts; no plan: the obstacle will be nearer than d_safe",
    ]


def test_a_token_of_another_build_is_refused(fmi_version: str, new_host: NewHost) -> None:
    host = new_host(fmi_version)
    host.fmu.guid = "{00000000-0000-0000-0000-000000000000}"
    with pytest.raises(Exception, match="nstantiate"):
        host.instantiate()
    assert "of different exports" in host.messages[-1]
