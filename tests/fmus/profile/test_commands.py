"""The inverse maps: what each kind of input is set to when the controller wants a force."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.description.model import Channel, Variable
from fmus.profile.commands import make_command
from fmus.profile.vehicle_profile import make_profile
from fmus.profile.wires import Wire

H = 0.05  # [s]
M, ALPHA = 1400.0, 80.0  # [kg], [N.s/m]
V = {"variable": "v"}
PROFILES = {
    "force": {"force": V},
    "split": {"drive_force": V, "brake_force": V},
    "acceleration": {"acceleration": V},
    "pedals": {
        "throttle": {"variable": "t", "full_force": 4000.0},
        "brake": {"variable": "b", "full_force": 9000.0},
    },
    "setpoint": {"speed_setpoint": {"variable": "v", "lead": 0.8}},
    "setpoint without lead": {"speed_setpoint": V},
}
forces = st.floats(-20_000.0, 20_000.0)
speeds = st.floats(0.0, 40.0)


def wire(scale: float = 1.0, shift: float = 0.0) -> Wire:
    return Wire("role", Channel(Variable("x", 1, "Real", "input")), scale, shift, "")


def command(kind: str, *wires: Wire, **inputs: float):
    profile = make_profile(
        {
            "inputs": {**PROFILES[kind], **inputs},
            "outputs": {"speed": V},
            "inverse_map": {"mass": M, "friction": ALPHA},
        },
        "test",
    )
    return make_command(profile, wires or (wire(), wire()), H)


def apply(command, force: float, speed: float) -> tuple[float, float]:
    inputs = memoryview(bytearray(16)).cast("d")
    command.apply(force, speed, inputs)
    return inputs[0], inputs[1]


@pytest.mark.parametrize(
    ("force", "speed", "expected"),
    [
        (0.0, 0.0, (0.0, 1800.0)),
        (-500.0, 0.1, (0.0, 1350.0)),
        (-2500.0, 0.1, (0.0, 2500.0)),  # the controller brakes harder
        (0.0, -0.3, (0.0, 1800.0)),  # it rolls back
        (0.0, 0.5, (0.0, 0.0)),
        (10.0, 0.0, (10.0, 0.0)),  # it is to drive off
    ],
)
def test_a_brake_is_held_at_a_standstill(force, speed, expected):
    assert apply(command("split", hold=1800.0), force, speed) == expected


# ---- numbers ----


@pytest.mark.parametrize(
    ("kind", "force", "speed", "expected"),
    [
        ("force", 1500.0, 3.0, (1500.0,)),
        ("force", -1500.0, 3.0, (-1500.0,)),
        ("split", 1500.0, 3.0, (1500.0, 0.0)),
        ("split", -1500.0, 3.0, (0.0, 1500.0)),
        ("split", -1500.0, 0.1, (0.0, 1500.0)),
        ("split", -1500.0, 0.0, (0.0, 0.0)),  # a bare mass would be driven backwards
        ("acceleration", 1500.0, 5.0, ((1500.0 - 80.0 * 5.0) / 1400.0,)),
        ("acceleration", -2800.0, 5.0, (-3200.0 / 1400.0,)),
        ("pedals", 1000.0, 5.0, (0.25, 0.0)),
        ("pedals", -4500.0, 5.0, (0.0, 0.5)),
        ("pedals", 8000.0, 5.0, (1.0, 0.0)),  # no further than fully pressed
        ("pedals", -20_000.0, 5.0, (0.0, 1.0)),
        ("setpoint", 1800.0, 5.0, (5.0 + 0.8 * 1400.0 / 1400.0,)),
        ("setpoint", -14_000.0, 5.0, (0.0,)),  # no car drives at a negative speed
        ("setpoint without lead", 1800.0, 5.0, (5.0 + H,)),
    ],
)
def test_what_the_fmu_gets(kind, force, speed, expected):
    given_to_fmu = apply(command(kind), force, speed)
    assert given_to_fmu[: len(expected)] == pytest.approx(expected, rel=1e-15, abs=1e-15)


@pytest.mark.parametrize("kind", ["force", "acceleration"])
@pytest.mark.parametrize("speed", [0.0, -0.02])
def test_a_standing_car_is_not_pushed_backwards(kind, speed):
    assert apply(command(kind), -500.0, speed)[0] == 0.0
    assert apply(command(kind), 500.0, speed)[0] > 0.0
    assert apply(command(kind, block_reverse=False), -500.0, speed)[0] < 0.0


@pytest.mark.parametrize("speed", [0.0, -0.02])
def test_a_standing_car_is_not_braked_backwards(speed):
    assert apply(command("split"), -500.0, speed) == (0.0, 0.0)
    assert apply(command("split"), 500.0, speed) == (500.0, 0.0)
    assert apply(command("split", block_reverse=False), -500.0, speed) == (0.0, 500.0)


def test_friction_alone_does_not_push_a_reversing_car_either():
    """(u - alpha v) / M is positive below 0 m/s: it stops the car."""
    assert apply(command("acceleration"), 0.0, -1.0)[0] == ALPHA / M


# ---- properties ----


@given(forces, speeds)
def test_the_car_of_the_inverse_map_moves_as_predicted(force, speed):
    """M a + alpha v = u, for an FMU that takes the acceleration."""
    acceleration = apply(command("acceleration", block_reverse=False), force, speed)[0]
    assert M * acceleration + ALPHA * speed == pytest.approx(force, rel=1e-12, abs=1e-8)


@given(st.floats(0.0, 20_000.0), speeds)
def test_a_speed_loop_with_the_lead_accelerates_as_predicted(force, speed):
    """v' = (v_set - v) / lead."""
    target = apply(command("setpoint"), force, speed)[0]
    assert target >= 0.0
    if target > 0.0:
        wanted = (force - ALPHA * speed) / M
        assert (target - speed) / 0.8 == pytest.approx(wanted, rel=1e-9, abs=1e-9)


@given(forces, speeds)
def test_drive_and_brake_are_never_negative_and_never_both(force, speed):
    for kind in ("split", "pedals"):
        drive, brake = apply(command(kind), force, speed)
        assert drive >= 0.0
        assert brake >= 0.0
        assert min(drive, brake) == 0.0


@pytest.mark.parametrize("kind", PROFILES)
@given(
    forces, speeds, st.floats(0.01, 1000.0), st.sampled_from([1.0, -1.0]), st.floats(-50.0, 50.0)
)
def test_every_input_is_in_the_unit_of_the_fmu(kind, force, speed, factor, sign, shift):
    """SI = scale * raw + shift, whatever the sign of the scale."""
    odd = wire(sign * factor, shift)
    raw = apply(command(kind, odd, odd), force, speed)
    si = apply(command(kind), force, speed)
    count = 2 if kind in ("split", "pedals") else 1
    for number in range(count):
        assert odd.to_si(raw[number]) == pytest.approx(si[number], rel=1e-9, abs=1e-6)
