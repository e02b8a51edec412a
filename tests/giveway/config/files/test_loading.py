"""Layers of settings become one configuration."""

from pathlib import Path

import pytest

from giveway.config import RunConfig
from giveway.config.files.layers import Layer, dump_toml, read_toml_text
from giveway.config.files.loading import as_layer, load
from giveway.errors import ConfigError, ScenarioError


def test_contradictory_egos_are_refused_if_one_origin_names_both() -> None:
    flags = {"ego": {"take_over": "5", "route": "a,b"}}
    with pytest.raises(ConfigError, match="--ego and --ego-route: contradict"):
        load([Layer("command line", flags, from_flags=True)])
    with pytest.raises(ConfigError, match=r"take_over and .* none: contradict"):
        load([Layer("study.toml", {"ego": {"take_over": "5", "none": True}})])
    config, _ = load([Layer("", {"scenario": "street", "ego": {"take_over": "x"}})])
    assert config.each_ego()[0].ego_id == "x"  # the scenario's own route gives way


def test_an_ego_taken_over_leaves_nothing_of_the_scenarios_route():
    """What is written down can be read again: the two kinds of ego would contradict each other."""
    config, _ = load([Layer("user", {"scenario": "shared_space", "ego": {"take_over": ["car"]}})])
    assert config.ego.route == ()
    assert load([Layer("again", config.model_dump())])[0] == config


def test_the_scenarios_settings_lie_beneath_the_users() -> None:
    config, scenario = load([Layer("", {"scenario": "shared_space", "seed": 5})])
    assert scenario.name == "shared_space"
    assert config.seed == 5
    assert config.crowd.host_edge
    assert config.ego.route


def test_a_run_config_object_overrides_only_what_it_sets() -> None:
    config, _ = load([as_layer(RunConfig(seed=9))])
    assert config.seed == 9
    assert config.ego.route


def test_an_unknown_scenario_is_guessed_at() -> None:
    with pytest.raises(ScenarioError, match="shared_space"):
        load([Layer("", {"scenario": "shared_spce"})])


def test_the_api_takes_names_and_files_and_refuses_the_rest(tmp_path: Path) -> None:
    assert as_layer("street").values == {"scenario": "street"}
    (tmp_path / "study.toml").write_bytes(b"\xef\xbb\xbfseed = 3\n")  # as Windows' editor saves it
    assert as_layer(tmp_path / "study.toml").values == {"seed": 3}
    for nonsense in (None, 3, ["street"]):
        with pytest.raises(ConfigError, match="expected a RunConfig"):
            as_layer(nonsense)  # type: ignore[arg-type]


@pytest.mark.parametrize("profile", [{"a": 1}, ["car.toml"], 3])
def test_a_profile_that_is_no_text_is_the_keys_fault(profile: object) -> None:
    with pytest.raises(ConfigError, match=r"run\.toml: \[vehicle\] profile.*text"):
        load([Layer("run.toml", {"vehicle": {"profile": profile}})])


def test_settings_from_python_may_be_dotted() -> None:
    dotted, _ = load([as_layer({"crowd.pedestrians": 7, "crowd": {"two_sided": True}, "seed": 3})])
    assert (dotted.crowd.pedestrians, dotted.crowd.two_sided, dotted.seed) == (7, True, 3)
    with pytest.raises(ConfigError, match=r"\[crowd\] pedestrains: unknown key; did you mean"):
        load([as_layer({"crowd.pedestrains": 7})])


FOUND = """
[inputs.force]
variable = "force"
[outputs.speed]
variable = "speed"
[model]
mass = 1800.0
friction = 90.0
r_squared = 1.0
speed_error = 0.01
position_error = 0.1
horizon = 0.75
time_step = 0.05
"""


def test_a_default_that_is_set_is_told_of_a_foreign_vehicle(tmp_path):
    """Also after a turn through config.toml: what is not told is found before the run."""
    profile = tmp_path / "car.toml"
    profile.write_text(FOUND, encoding="utf-8")
    told = {"fmu": "car.fmu", "mass": 1000.0}
    egos = [
        {"ego": {"id": "a"}, "vehicle": told},
        {"ego": {"id": "b"}, "vehicle": {"fmu": "b.fmu"}},
    ]
    known = {"mass": 1800.0, "friction": 90.0, "force_limit": 14400.0, "force_rate_limit": 1800.0}
    run = {"fmu": "x.fmu", "profile": str(profile)}
    for values, expected in (
        ({"vehicle": told}, [{"mass": 1000.0}]),
        ({"egos": egos}, [{"mass": 1000.0}, {}]),
        ({"vehicle": run, "egos": egos}, [{"mass": 1000.0}, {}]),
        ({"vehicle": run, "egos": [{"ego": {"id": "c"}}]}, [known]),
    ):
        config = load([Layer("user", values)])[0]
        again = load([read_toml_text(dump_toml(config), "config.toml")])[0]
        assert [ego.vehicle.told for ego in config.each_ego()] == expected
        assert [ego.vehicle.told for ego in again.each_ego()] == expected
        assert dump_toml(again) == dump_toml(config)
