"""The configuration: layers, validation in one line, and the round trip through TOML."""

from pathlib import Path

import pytest

import giveway
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.layers import (
    Layer,
    Option,
    build_config,
    options,
)
from giveway.config.tables.controllers import PaperMpcOptions
from giveway.errors import ConfigError, GivewayError


def explain(values: dict, *, flags: bool = False) -> str:
    with pytest.raises(ConfigError) as caught:
        build_config([Layer("study.toml", values, from_flags=flags)])
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_defaults_are_the_papers_table() -> None:
    config, own = EgoRunConfig(controller="mpc-paper"), PaperMpcOptions()
    assert (config.vehicle.mass, config.vehicle.friction) == (1000, 100)
    assert (config.vehicle.force_limit, config.vehicle.force_rate_limit) == (8000, 1000)
    assert (own.horizon, config.vehicle.speed_max) == (15, 20)
    assert (own.integral_gain, own.derivative_gain) == (10, 100)
    assert (config.reference_speed, config.regulation.safe_distance) == (4, 8)
    assert own.buffer_distance == config.buffer_distance == 10


@pytest.mark.parametrize(
    ("values", "parts"),
    [
        (
            {"crowd": {"pedestrians": -3}},
            ["study.toml: [crowd] pedestrians", "-3", "at least 0", "persons"],
        ),
        ({"seed": "a"}, ["study.toml: seed", "'a'", "whole number"]),
        ({"controller": "mcp"}, ["'mcp'", "'mpc'", "'pid-tuned'", "'pid-paper'"]),
        ({"vehicle": {"mass": float("nan")}}, ["[vehicle] mass", "nan", "finite"]),
        ({"vehicle": {"mass": 0.0}}, ["[vehicle] mass", "greater than 0", "kg"]),
        ({"ego": {"initial_speed": 1e9}}, ["[ego] initial_speed", "m/s"]),
        ({"crowd": {"spawn_area": [1, 2, 0, 4]}}, ["spawn_area", "x_min < x_max", "[m]"]),
        ({"crowd": {"spawn_area": "1,2,3"}}, ["spawn_area", "1", "4 values"]),
        ({"crowd": {"spawn_area": "1,2,x,4"}}, ["spawn_area", "x", "number"]),
        ({"crowd": {"pedestrans": 3}}, ["[crowd] pedestrans", "did you mean 'pedestrians'"]),
        ({"crwd": {}}, ["crwd", "did you mean 'crowd'"]),
        ({"zzz": 1}, ["zzz", "expected one of", "scenario"]),
        ({"crowd": 3}, ["crowd", "table"]),
    ],
)
def test_a_bad_value_is_explained_in_one_line(values: dict, parts: list[str]) -> None:
    message = explain(values)
    for part in parts:
        assert part in message


def nonsense() -> list[tuple[Option, float]]:
    """Every option with a bound, and a value far beyond it."""
    found = []
    for option in options():
        limits = option.field.metadata
        lowest = [getattr(limit, "ge", getattr(limit, "gt", None)) for limit in limits]
        if any(lowest) or (0 in lowest and not any(hasattr(limit, "le") for limit in limits)):
            found.append((option, -1.0))
        if any(hasattr(limit, "lt") or hasattr(limit, "le") for limit in limits):
            found.append((option, 1e12))
        if option.extra["least"] is not None:
            found.append((option, 1e-9))
    return found


@pytest.mark.parametrize(
    ("option", "value"),
    [pytest.param(*pair, id=f"{pair[0].flag}={pair[1]}") for pair in nonsense()],
)
def test_a_value_that_makes_no_sense_is_refused_with_the_reason(
    option: Option, value: float
) -> None:
    settings: dict = {option.location[-1]: int(value) if abs(value) >= 1 else value}
    for table in reversed(option.location[:-1]):
        settings = {table: settings}
    too_small, too_large = option.extra["because"]
    assert f": {too_large if value > 1.0 else too_small} (" in explain(settings)


def test_no_length_or_duration_or_force_may_be_a_billionth() -> None:
    free = {  # where next to nothing is as good as nothing
        "depart_time", "depart_position", "friction", "near",
        "position_noise", "initial_speed", "desired_speed_sd",
    }  # fmt: skip
    for option in options():
        bound = any(hasattr(limit, "gt") or hasattr(limit, "ge") for limit in option.field.metadata)
        if bound and option.unit and option.location[-1] not in free:
            lowest = [getattr(limit, "ge", 0) for limit in option.field.metadata]
            assert option.extra["least"] or max(lowest) > 0 or option.unit == "persons", option.flag


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"vehicle": {"friction": 1e6}}, "friction alone would turn the vehicle round within one"),
        (
            {"crowd": {"desired_speed_bounds": (2, 1)}},
            "bounds = 2,1: expected two speeds, the small",
        ),
        ({"crowd": {"desired_speed_bounds": (0.5, 9)}}, "from 0.1 to 2.5"),
        ({"crowd": {"desired_speed_bounds": (1.4, 2)}}, "mean = 1.394: expected 1.4 to 2"),
        ({"crowd": {"spawn_area": (0, 0, 1e-9, 5)}}, "1e-09 by 5 m: expected sides of at least"),
        ({"crowd": {"walk": (1e-9, 0)}}, "a shorter way is not a walk"),
    ],
)
def test_values_that_make_no_sense_together_are_refused_too(values: dict, said: str) -> None:
    assert said in explain(values)


def test_a_bad_flag_is_named_as_a_flag() -> None:
    assert "--pedestrians = '-1'" in explain({"crowd": {"pedestrians": "-1"}}, flags=True)
    assert "--groups" in explain({"crowd": {"groups": "1.5"}}, flags=True)


def test_a_contradiction_between_keys_names_their_table() -> None:
    values = {"crowd": {"spawn_area": (5, 0, 1, 1)}}
    assert explain(values).startswith("study.toml: [crowd] spawn_area: expected x_min < x_max")
    assert explain(values, flags=True).startswith("[crowd] spawn_area: expected x_min < x_max")
    assert "[crowd] spawn_area and walk" in explain({"crowd": {"walk": (0, 1e300)}})


def test_speeds_outside_of_the_mpcs_limits_are_refused() -> None:
    assert "expected at most [vehicle] speed_max, 3 [m/s]" in explain(
        {"controller": "mpc-paper", "vehicle": {"speed_max": 3}}
    )
    assert "[ego] initial_speed = 30" in explain(
        {"controller": "mpc-paper", "ego": {"initial_speed": 30}}
    )
    build_config([Layer("", {"controller": "pid", "ego": {"initial_speed": 30}})])


def test_a_radius_may_be_a_number() -> None:
    assert RunConfig.model_validate({"crowd": {"zone": 30}}).crowd.zone == "30"


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"ego": {"id": "we ird;id"}}, r"ego.* id = 'we ird;id'"),
        ({"sumo": {"options": "'unclosed"}}, r"options = \"'unclosed\".*as in a shell"),
        ({"sumo": {"seed": "today"}}, r"seed = 'today'"),
    ],
)
def test_texts_that_sumo_could_not_use_are_refused(settings: dict, expected: str) -> None:
    with pytest.raises(ConfigError, match=expected):
        build_config([Layer("study.toml", settings)])


@pytest.mark.parametrize(
    "settings",
    [
        {"vehicle": {"fmu": "v" * 3000 + ".fmu"}},
        {"vehicle": {"profile": "v" * 3000 + ".toml"}},
        {"crowd": {"preset": "p" * 3000 + ".toml"}},
        {"scenario": "s" * 3000 + ".sumocfg"},
    ],
)
def test_a_file_name_that_is_too_long_is_one_line(settings: dict, tmp_path: Path) -> None:
    file = tmp_path / "run.toml"
    lines = [
        f"{key} = {value!r}"
        if isinstance(value, str)
        else f"{key}.{next(iter(value))} = {next(iter(value.values()))!r}"
        for key, value in settings.items()
    ]
    file.write_text("\n".join(lines))
    with pytest.raises(GivewayError) as refused:
        giveway.run(file)
    assert "\n" not in str(refused.value)


def test_people_are_mixed_unless_the_papers_controllers_drive() -> None:
    def of(**settings) -> str:
        return RunConfig.model_validate(settings).crowd.preset

    assert of() == of(controller="pid-tuned") == of(ego={"none": True}) == "MIXED"
    assert of(controller="mpc-paper") == of(controller="pid-paper") == "SIM"
    assert of(controller="pid", ego={"none": True}) == "SIM"
    assert of(controller="mpc-paper", crowd={"pedestrians": 3}) == "SIM"
    assert of(controller="mpc-paper", crowd={"preset": "MIXED"}) == "MIXED"
    assert of(crowd={"preset": "TABLE2"}) == "TABLE2"


def test_egos_with_different_declarations_meet_the_default() -> None:
    def of(*controllers: str) -> str:
        egos = [{"controller": one, "ego": {"id": f"ego{i}"}} for i, one in enumerate(controllers)]
        config = RunConfig.model_validate({"egos": egos})
        assert {ego.crowd.preset for ego in config.each_ego()} == {config.crowd.preset}
        return config.crowd.preset

    assert of("mpc-paper", "pid-paper") == "SIM"
    assert of("mpc-paper", "mpc") == of("mpc", "mpc-paper") == of("mpc") == "MIXED"


def test_the_declared_preset_does_not_count_as_set_by_the_user() -> None:
    paper = RunConfig(controller="mpc-paper")
    assert paper.model_dump(exclude_unset=True) == {"controller": "mpc-paper"}
    assert "preset" not in paper.crowd.model_fields_set
    again = RunConfig.model_validate_json(paper.model_dump_json())
    assert again == paper
    assert EgoRunConfig(controller="mpc-paper").crowd.preset == "SIM"


def test_json_for_workers_tells_no_mass_that_nobody_has_told() -> None:
    config = RunConfig.model_validate({"vehicle": {"fmu": "bus.fmu"}, "seed": 3})
    again = RunConfig.model_validate_json(config.as_json())
    assert again == config
    assert again.vehicle.model_fields_set == {"fmu"}
    heavy = RunConfig.model_validate({"vehicle": {"fmu": "bus.fmu", "mass": 1000.0}})
    assert "mass" in RunConfig.model_validate_json(heavy.as_json()).vehicle.model_fields_set
