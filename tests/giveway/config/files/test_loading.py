"""Layers of settings become one configuration."""

from pathlib import Path

import pytest

from giveway.config import RunConfig
from giveway.config.files.layers import (
    Layer,
)
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
