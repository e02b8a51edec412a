"""The table [rules]."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.layers import Layer, build_config, dump_toml
from giveway.config.option import Section
from giveway.config.tables.rules import OF_PRIORITY, RulesConfig
from giveway.errors import ConfigError

NAMES = tuple(RulesConfig.model_fields)


def ego(**settings: Any) -> EgoRunConfig:
    return EgoRunConfig.model_validate(settings)


def built(settings: dict[str, Any]) -> RunConfig:
    return build_config([Layer("run.toml", settings)])


def test_left_out_the_paper_s_controllers_keep_no_priority() -> None:
    for controller, kept in (("mpc", True), ("pid-tuned", True), ("mpc-paper", False)):
        config = ego(controller=controller)
        assert {config.heeds(name) for name in OF_PRIORITY} == {kept}
        assert config.heeds("traffic_lights")
        assert config.heeds("following")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("controller", ["mpc", "mpc-paper"])
def test_what_the_user_says_holds(name: str, controller: str) -> None:
    own = {"controller": controller, "regulation": {"reference_speed": 4.0}}
    for said in (True, False):
        assert ego(**own, rules={name: said}).heeds(name) == said


def test_lanes_give_the_speed_unless_a_number_does() -> None:
    assert ego().heeds("speed_limits")
    assert not ego(regulation={"reference_speed": 4.0}).heeds("speed_limits")
    with pytest.raises(ConfigError, match=r"\[rules\] speed_limits = false.*give a speed"):
        built({"rules": {"speed_limits": False}})


def test_an_ego_has_rules_of_its_own() -> None:
    run = {"rules": {"crossings": False}, "egos": ({"rules": {"merging": False}}, {})}
    first, second = built(run).each_ego()
    assert [first.heeds(name) for name in ("crossings", "merging")] == [False, False]
    assert [second.heeds(name) for name in ("crossings", "merging")] == [False, True]


def test_a_misspelt_rule_is_answered_with_the_one_meant() -> None:
    with pytest.raises(ConfigError, match=r"run.toml: \[rules\] crosings: .*'crossings'"):
        built({"rules": {"crosings": False}})


def test_rules_of_other_packages_are_named_with_their_options() -> None:
    own = {"mine:Rule": {"limit": 8.0}, "mine:Other": True, "mine:Off": False}
    config = built({"rules": {"crossings": True, **own}})
    assert config.rules.plugged_in == {"mine:Rule": {"limit": 8.0}, "mine:Other": {}}
    written = tomllib.loads(dump_toml(config))["rules"]
    assert written == {"crossings": True, "mine:Rule": {"limit": 8.0}, "mine:Other": True}


def test_a_metric_is_none_of_one_ego() -> None:
    with pytest.raises(ConfigError, match="unknown key 'metrics'"):
        built({"egos": ({"metrics": {"mine:Metric": True}},)})


def test_the_table_is_like_the_others() -> None:
    assert issubclass(RulesConfig, Section)
    assert RulesConfig.model_config["frozen"]
