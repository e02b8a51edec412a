"""Layers of settings: from files, flags and Python."""

import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.config import RunConfig
from giveway.config.files.layers import (
    Layer,
    build_config,
    dump_toml,
    flag_of,
    options,
    read_toml,
)
from giveway.errors import ConfigError


def test_toml_round_trip_is_exact() -> None:
    config = RunConfig.model_validate(
        {"seed": 7, "crowd": {"spawn_area": (0.1, 0.2, 3, 4)}, "sumo": {"step_length": 0.1}}
    )
    again = build_config([Layer("dump", tomllib.loads(dump_toml(config)))])
    assert again == config


@given(
    seed=st.integers(0, 2**31 - 1),
    mass=st.floats(10, 1e6),
    speed=st.floats(0, 70),
    two_sided=st.booleans(),
)
def test_toml_round_trip_of_any_numbers(
    seed: int, mass: float, speed: float, two_sided: bool
) -> None:
    values = {
        "seed": seed,
        "controller": "pid",  # the MPC's speed limits bound the initial speed
        "vehicle": {"mass": mass},
        "ego": {"initial_speed": speed},
        "crowd": {"two_sided": two_sided},
    }
    config = RunConfig.model_validate(values)
    assert build_config([Layer("dump", tomllib.loads(dump_toml(config)))]) == config


def test_every_option_has_its_own_flag_and_a_meaning() -> None:
    flags = [option.flag for option in options()]
    assert len(flags) == len(set(flags))
    assert all(option.field.description for option in options())
    assert flag_of(("crowd", "pedestrians")) == "--pedestrians"
    assert flag_of(("crowd", "sampler")) == "--sampler"


@pytest.mark.parametrize("controller", [{"a": 1}, [1], True])
def test_a_table_for_a_controllers_name_is_refused(controller: object) -> None:
    layers = [Layer("scenario", {"controller": "mpc"}), Layer("mine", {"controller": controller})]
    with pytest.raises(ConfigError, match="mine: controller = "):
        build_config(layers)


def test_later_layers_win_key_by_key() -> None:
    below = Layer("a", {"seed": 1, "vehicle": {"mass": 2000, "force_limit": 5000}})
    above = Layer("b", {"vehicle": {"mass": 3000}})
    config = build_config([below, above])
    assert (config.seed, config.vehicle.mass, config.vehicle.force_limit) == (1, 3000, 5000)


@pytest.mark.parametrize(
    ("content", "part"),
    [("seed = ", "not valid TOML"), ("\xff\xfe", "not UTF-8"), (None, "no such file")],
)
def test_an_unreadable_file_is_named(tmp_path: Path, content: str | None, part: str) -> None:
    path = tmp_path / "study.toml"
    if content is not None:
        path.write_bytes(content.encode("latin-1"))
    with pytest.raises(ConfigError, match=part) as caught:
        read_toml(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("given", ["lane", 6.5, "6.5"])
def test_the_reference_speed_is_a_number_or_the_lane_s(given: object) -> None:
    entry = {"regulation": {"reference_speed": given}}
    config = build_config([Layer("file", {"egos": [entry], **entry})])
    expected = "lane" if given == "lane" else 6.5
    assert config.regulation.reference_speed == expected
    assert config.each_ego()[0].regulation.reference_speed == expected
    again = build_config([Layer("dump", tomllib.loads(dump_toml(config)))])
    assert again.regulation == config.regulation


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("lanes", "expected a number or 'lane' "),
        (61, "should be at most 60 "),
        (0.05, "should be at least 0.1 "),
    ],
)
def test_another_reference_speed_is_refused(given: object, expected: str) -> None:
    entry = {"regulation": {"reference_speed": given}}
    with pytest.raises(ConfigError, match=rf"^file: \[regulation\] reference_speed = .*{expected}"):
        build_config([Layer("file", entry)])
    with pytest.raises(ConfigError, match=rf"egos\[0\]: regulation.reference_speed = .*{expected}"):
        build_config([Layer("file", {"egos": [entry]})])


def test_a_table_in_place_of_a_plug_ins_name_is_one_line() -> None:
    layers = [Layer("a.toml", {"controller": "mpc"}), Layer("b.toml", {"controller": {"a": 1}})]
    with pytest.raises(ConfigError, match="controller"):
        build_config(layers)
