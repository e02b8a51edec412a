"""The profile file: what it may say, and the one line that refuses what it may not."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from fmus import FmuProfileError, make_profile, read_profile

FORCE = '[inputs.force]\nvariable = "F"\n'
SPEED = '[outputs.speed]\nvariable = "v"\n'
DOCUMENT = Path(__file__).parents[3] / "docs" / "vehicles.md"


@pytest.fixture
def refusal(tmp_path):
    """The message for a profile of this text, without the file's name before it."""

    def read(text: str | bytes) -> str:
        path = tmp_path / "car.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(FmuProfileError) as caught:
            read_profile(path)
        message = str(caught.value)
        assert message.startswith(f"{path}: ")
        assert "\n" not in message
        return message.removeprefix(f"{path}: ")

    return read


def profile(text: str):
    return make_profile(tomllib.loads(text), "test")


# ---- what it may say ----


def test_two_tables_are_enough():
    found = profile(FORCE + SPEED)
    assert found.inputs.block_reverse
    assert found.initial.run_up
    assert found.fmu.self_check
    assert (found.fmu.step, found.fmu.start_timeout, found.fmu.step_timeout) == (None, 60.0, 10.0)
    assert (found.limits.speed, found.limits.position_jump, found.limits.frozen_time) == (100, 1, 2)
    assert (found.inverse_map.mass, found.inverse_map.friction) == (1000.0, 100.0)


def test_start_values_keep_their_types():
    parameters = profile(
        FORCE + SPEED + "[parameters]\na = 2\nb = 2.0\nc = true\nd = 'x'\ne = [1, 2.5]\n"
    ).parameters
    assert parameters == {"a": 2, "b": 2.0, "c": True, "d": "x", "e": [1, 2.5]}
    assert [type(parameters[name]) for name in "abcd"] == [int, float, bool, str]


@pytest.mark.parametrize(
    "text",
    ['"car.body.mass" = 5.0', "car.body.mass = 5.0", "car.body = {mass = 5.0}"],
)
def test_a_variable_of_a_hierarchy_needs_no_quotes(text):
    """Names like car.body.mass are the rule; in TOML such a key is a table."""
    assert profile(FORCE + SPEED + f"[parameters]\n{text}\n").parameters == {"car.body.mass": 5.0}


def test_a_byte_order_mark_does_no_harm(tmp_path):
    path = tmp_path / "car.toml"
    path.write_bytes(b"\xef\xbb\xbf" + (FORCE + SPEED).encode())
    assert read_profile(path).inputs.force.variable == "F"


def test_the_examples_of_the_documentation_are_profiles():
    """Each block of TOML with inputs and outputs; the parts of one are tried with what lacks."""
    blocks = [b.partition("```")[0] for b in DOCUMENT.read_text("utf-8").split("```toml\n")[1:]]
    assert len(blocks) >= 8
    for block in blocks:
        complete = block
        if "[inputs." not in block:
            complete += FORCE
        if "[outputs.speed]" not in complete:
            complete += SPEED
        profile(complete)


# ---- what it may not ----


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "[inputs]: missing; add it (docs/vehicles.md)"),
        (FORCE, "[outputs]: missing"),
        (FORCE + "[outputs]\n", "[outputs] speed: missing"),
        ("[inputs]\n" + SPEED, "[inputs]: no input: expected one of force; drive_force"),
        (FORCE + SPEED + "[engine]\n", "[engine]: unknown key; docs/vehicles.md lists the keys"),
        (FORCE + "sign = -1\n" + SPEED, "[inputs.force] sign: unknown key"),
        (FORCE + "gain = 0\n" + SPEED, "[inputs.force]: gain = 0: expected a number that is not 0"),
        (FORCE + "gain = nan\n" + SPEED, "[inputs.force] gain = nan"),
        (FORCE + "gain = '-'\n" + SPEED, "[inputs.force] gain = '-'"),
        ("[inputs.force]\nvariable = ''\n" + SPEED, "[inputs.force] variable = ''"),
        ("[inputs.force]\nvariable = 1\n" + SPEED, "[inputs.force] variable = 1"),
        ("inputs = 1\n" + SPEED, "[inputs] = 1"),
        (FORCE + SPEED + "[fmu]\nstep = 0\n", "[fmu] step = 0"),
        (FORCE + SPEED + "[fmu]\nstep = inf\n", "[fmu] step = inf"),
        (FORCE + SPEED + "[fmu]\nkind = 'cs'\n", "[fmu] kind = 'cs'"),
        (FORCE + SPEED + "[fmu]\nsolver = 'euler'\n", "[fmu] solver = 'euler'"),
        (FORCE + SPEED + "[fmu]\nstep_timeout = -1\n", "[fmu] step_timeout = -1"),
        (FORCE + SPEED + "[limits]\nspeed = 0\n", "[limits] speed = 0"),
        (FORCE + SPEED + "[inverse_map]\nmass = 0\n", "[inverse_map] mass = 0"),
        (FORCE + SPEED + "[model]\nmass = 1\n", "[model] friction: missing"),
        (FORCE + SPEED + "[parameters]\nm = nan\n", "[parameters]: m = nan: expected a finite"),
        (FORCE + SPEED + "[parameters]\nm = [[1]]\n", "[parameters]: m = [[1]]: expected a fin"),
        (FORCE + SPEED + "[parameters]\nm = [1, 'a']\n", "[parameters]: m = [1, 'a']: expected"),
        (FORCE + SPEED + "[parameters]\nm = 2024-01-01\n", "[parameters]: m = 2024-01-01: expec"),
        (FORCE + SPEED + f"[parameters]\nm = 1{'0' * 400}\n", "[parameters]: m = 1000"),
        (FORCE + SPEED + "parameters = 3\n", "[outputs.speed] parameters: unknown key"),
        ("parameters = 3\n" + FORCE + SPEED, "[parameters] = 3"),
    ],
)
def test_what_is_refused(refusal, text, said):
    message = refusal(text)
    assert message.startswith(said)
    assert len(message) < 300


@pytest.mark.parametrize(
    ("key", "value"), [("lag", 1e308), ("delay", 9), ("horizon", 1e-308), ("position_error", 1e308)]
)
def test_an_identified_model_that_nobody_can_drive_is_refused(refusal, key, value):
    model = {"mass": 1000, "friction": 100, "r_squared": 0.9, "speed_error": 0.1}
    model |= {"position_error": 0.1, "horizon": 0.75, "time_step": 0.05, key: value}
    lines = "".join(f"{name} = {number!r}\n" for name, number in model.items())
    assert refusal(f"{FORCE}{SPEED}[model]\n{lines}").startswith(f"[model] {key} = {value!r}")


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        (FORCE + '[inputs.acceleration]\nvariable = "a"\n', "force; acceleration: expected one of"),
        (
            '[inputs.drive_force]\nvariable = "a"\n',
            "drive_force without brake_force: add [inputs.b",
        ),
        (
            '[inputs.brake_force]\nvariable = "a"\n',
            "brake_force without drive_force: add [inputs.d",
        ),
        (
            '[inputs.throttle]\nvariable = "a"\nfull_force = 1\n',
            "throttle without brake: add [inputs.brake]",
        ),
    ],
)
def test_there_is_one_way_to_be_driven(refusal, tables, said):
    assert refusal(tables + SPEED).startswith(f"[inputs]: {said}")


def test_a_pedal_has_its_full_force(refusal):
    pedals = '[inputs.throttle]\nvariable = "a"\n[inputs.brake]\nvariable = "b"\nfull_force = 1\n'
    assert refusal(pedals + SPEED).startswith("[inputs.throttle] full_force: missing")


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"[inputs\n", "not valid TOML"), (b"\xff\xfe\x00", "cannot be read (not UTF-8 text)")],
)
def test_what_is_no_toml(refusal, content, said):
    assert refusal(content).startswith(said)


def test_what_is_no_file(tmp_path):
    with pytest.raises(FmuProfileError, match=r"car\.toml: no such file; 'giveway fmu inspect"):
        read_profile(tmp_path / "car.toml")
    with pytest.raises(FmuProfileError, match="cannot be read"):
        read_profile(tmp_path)


def test_a_message_shows_the_beginning_of_a_long_value(refusal):
    said = refusal(f'[inputs.force]\nvariable = "u"\n[fmu]\nkind = "{"x" * 5000}"\n' + SPEED)
    assert said.startswith("[fmu] kind = 'xxx")
    assert len(said) < 200
