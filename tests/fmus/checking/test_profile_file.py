"""The identified model in the user's own file."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus import FmuProfileError
from fmus.checking.profile_file import profile_text, with_model
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.profile.vehicle_profile import FittedModel, SideModel, make_profile

TEXT = """# my car
[inputs.force]
variable = "f"  # the wheels'

[model]
mass = 1.0  # an old one

[outputs.speed]
variable = "v"
unit = "km/h"  # as the dash board
"""
positive = st.floats(1e-3, 1e5)


def model(**values):
    return FittedModel(
        **(
            {"mass": 1523.5, "friction": 43.25, "r_squared": 0.998, "speed_error": 0.01,
             "position_error": 0.12, "horizon": 0.75, "time_step": 0.05} | values
        )
    )  # fmt: skip


def test_only_the_model_changes():
    text = with_model(TEXT, model())
    values = tomllib.loads(text)
    assert values.pop("model")["mass"] == 1523.5
    old = tomllib.loads(TEXT)
    del old["model"]
    assert values == old
    for line in TEXT.splitlines():
        assert line in text or line == "mass = 1.0  # an old one"


def test_a_profile_without_a_model_gets_one():
    text = with_model('[inputs.force]\nvariable = "f"', model())
    assert tomllib.loads(text)["model"]["position_error"] == 0.12
    assert text.startswith('[inputs.force]\nvariable = "f"\n')


def test_writing_twice_is_writing_once():
    once = with_model(TEXT, model())
    assert with_model(once, model()) == once


def test_each_side_has_a_table_and_seen_limits_a_line():
    sides = {
        "drive": SideModel(mass=1450.0, lag=0.5, delay=0.1, limit=3.1, power_from=12.0, rate=5.0),
        "brake": SideModel(mass=1400.0),
    }
    text = with_model(TEXT, model(**sides))
    assert with_model(text, model(**sides)) == text
    values = tomllib.loads(text)["model"]
    assert values["brake"] == {"mass": 1400.0, "lag": 0.0, "delay": 0.0}
    assert values["drive"]["power_from"] == 12.0
    assert make_profile(tomllib.loads(text), "test").model == model(**sides)
    assert "[model.drive]" not in with_model(text, model())


@pytest.mark.parametrize(
    ("side", "values", "line"),
    [
        ("brake", {"limit": 3.0, "power_from": 9.0}, "brake.power_from: brakes have no limit"),
        ("drive", {"power_from": 9.0}, "drive.power_from without drive.limit: add `limit`"),
        ("drive", {"limit": 0.0}, r"\[model.drive\] limit = 0.0"),
    ],
)
def test_sides_that_make_no_sense_are_refused(side, values, line):
    text = with_model(TEXT, model())
    read = tomllib.loads(text)
    read["model"][side] = {"mass": 1450.0} | values
    with pytest.raises(FmuProfileError, match=line):
        make_profile(read, "test")


@given(positive, positive)
def test_what_is_written_is_read_back(mass, friction):
    text = with_model(profile_text(BUNDLED_PROFILE, "ours"), model(mass=mass, friction=friction))
    profile = make_profile(tomllib.loads(text), "test")
    assert profile.model is not None
    assert abs(profile.model.mass - mass) <= 1e-9 * mass
    assert abs(profile.model.friction - friction) <= 1e-9 * friction
    assert profile.model_copy(update={"model": None}) == BUNDLED_PROFILE
