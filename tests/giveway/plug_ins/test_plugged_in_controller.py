"""Somebody else's controller: what it is shown, what its answers mean, what becomes of bad ones."""

from __future__ import annotations

import numpy as np
import pytest

from controller import (
    Acceleration,
    Force,
    Observation,
    PlugInError,
    Setup,
    Speed,
)
from giveway.plug_ins.plugged_in_controller import PluggedIn

SETUP = Setup(0.05, 1000.0, 100.0, 4.0, 2.0, 5000.0, 2.0)


class Answers:
    def __init__(self, answer: object) -> None:
        self.answer = answer

    def control(self, seen: Observation) -> object:
        return self.answer(seen) if callable(self.answer) else self.answer


def asked(answer: object, **seen: object):
    observation = Observation(0.0, 3.0, np.inf, np.full(4, np.inf), **seen)
    return PluggedIn("'a:B' of 'ego'", lambda: Answers(answer), SETUP).control(observation)


@pytest.mark.parametrize(
    ("answer", "force"),
    [
        (700, 700.0),
        (np.float32(-1.5), -1.5),
        (Force(250.0), 250.0),
        (Acceleration(0.5), 0.5 * 1000.0 + 100.0 * 3.0),
        (Speed(3.5, lead=1.0), 0.5 * 1000.0 + 100.0 * 3.0),
        (Speed(3.1), 0.1 / 0.05 * 1000.0 + 100.0 * 3.0),
        (Force(9e9), 5000.0),
        (Acceleration(-20.0), -5000.0),
    ],
)
def test_an_answer_becomes_a_force_within_the_actuators_limits(answer, force):
    decision = asked(answer)
    assert decision.force == pytest.approx(force)
    assert decision.acting == "plug-in"
    assert decision.reference_speed == 4.0


def test_the_inverse_is_that_of_fmus_with_speed_or_acceleration():
    """What the inverse maps of the roles would set comes back."""
    from fmus.profile.commands import AccelerationCommand, SetpointCommand
    from fmus.profile.wires import Wire

    raw = np.zeros(1)
    wire = Wire("own", None, 1.0, 0.0, "")
    AccelerationCommand(wire, 1000.0, 100.0, False).apply(
        asked(Acceleration(0.7)).force, 3.0, memoryview(raw)
    )
    assert raw[0] == pytest.approx(0.7)
    SetpointCommand(wire, 1000.0, 100.0, 0.5).apply(
        asked(Speed(3.4, lead=0.5)).force, 3.0, memoryview(raw)
    )
    assert raw[0] == pytest.approx(3.4)


def test_its_reason_is_in_the_decision():
    assert asked(Force(0.0, "somebody\nin front")).reason == "somebody in front"


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (Acceleration(np.nan), "finite number [m/s^2]"),
        (Force(-np.inf), "finite number [N]"),
        (Speed(1.0, lead=np.nan), "finite number [s]"),
        (np.array([1.0, 2.0]), "one number"),
        (np.array([1.0]), "one number"),
        (None, "one number"),
        (True, "one number"),
        ("brake", "one number"),
        (Force("much"), "one number"),
        (Force(0.0, 5), "words as its reason"),
    ],
)
def test_an_answer_that_is_no_number_is_told_on_one_line(answer, said):
    with pytest.raises(PlugInError, match=r"^'a:B' of 'ego' returned ") as caught:
        asked(answer)
    assert said in str(caught.value)
    assert str(caught.value).isprintable()


class Unprintable:
    def __repr__(self) -> str:
        raise RuntimeError("no")


def test_whatever_it_returns_can_be_told():
    with pytest.raises(PlugInError, match="a Unprintable"):
        asked(Unprintable())
    with pytest.raises(PlugInError) as caught:
        asked(np.zeros(5000))
    assert len(str(caught.value)) < 250


def fails(seen: Observation) -> float:
    return 1.0 / (seen.speed - 3.0)


def leaves(seen: Observation) -> float:
    raise SystemExit(3)


def test_what_it_raises_is_told_with_kind_text_and_place():
    expected = r"raised ZeroDivisionError: .*division by zero \(test_plugged_in_controller.py:\d+\)"
    with pytest.raises(PlugInError, match=expected):
        asked(fails)
    with pytest.raises(
        PlugInError, match=r"raised SystemExit: 3 \(test_plugged_in_controller.py:\d+\)"
    ):
        asked(leaves)


@pytest.mark.parametrize("name", ["obstacle_positions", "vehicles", "lane_speeds", "person_ids"])
def test_the_runs_arrays_cannot_be_written(name):
    own = np.ones((4, 1, 7)) if name == "vehicles" else np.ones(4)
    observation = Observation(0.0, 3.0, np.inf, np.ones(4)).replaced(**{name: own})

    def write(seen: Observation) -> float:
        getattr(seen, name)[:] = 7.0
        return 0.0

    plugged = PluggedIn("'a:B'", lambda: Answers(write), SETUP)
    with pytest.raises(PlugInError, match="read-only"):
        plugged.control(observation)
    assert own.flags.writeable
    assert (own == 1.0).all()


def test_people_cannot_be_moved():
    from giveway.plug_ins.plugged_in_controller import _SeenPeople

    people = _SeenPeople(np.ones((2, 2)), np.zeros((2, 2)))

    def push(seen: Observation) -> float:
        seen.people.position[0] += 1.0
        return 0.0

    with pytest.raises(PlugInError, match="read-only"):
        asked(push, people=people)
    assert (people.position == 1.0).all()


@pytest.mark.parametrize("horizon", [-1, 1.5, True, "ten", None, 10**9])
def test_a_horizon_is_a_number_of_steps(horizon):
    plug_in = Answers(0.0)
    plug_in.horizon = horizon
    with pytest.raises(PlugInError, match="horizon"):
        PluggedIn("'a:B'", lambda: plug_in, SETUP)


def test_what_has_no_control_is_no_controller():
    with pytest.raises(PlugInError, match="expected an object with a method control"):
        PluggedIn("'a:B'", dict, SETUP)
    with pytest.raises(PlugInError, match=r"raised ValueError: bad .* when it was made"):
        PluggedIn("'a:B'", lambda: (_ for _ in ()).throw(ValueError("bad")), SETUP)


def test_optional_methods_are_called_if_they_are_there():
    calls = []
    plug_in = Answers(0.0)
    plain = PluggedIn("'a:B'", lambda: Answers(0.0), SETUP)
    plain.reset()
    plain.applied(1.0)
    plug_in.reset = lambda: calls.append("reset")
    plug_in.applied = calls.append
    plugged = PluggedIn("'a:B'", lambda: plug_in, SETUP)
    plugged.reset()
    plugged.applied(5.0)
    assert calls == ["reset", 5.0]
