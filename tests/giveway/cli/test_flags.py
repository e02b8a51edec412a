"""Flags of the command line: --rule and --metric as the tables."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from giveway.cli.flags import set_plug_ins
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.layers import Layer, build_config, dump_toml
from giveway.errors import ConfigError
from giveway.plug_ins.sockets import METRIC, RULE


def ego(**settings: Any) -> EgoRunConfig:
    return EgoRunConfig.model_validate(settings)


def built(settings: dict[str, Any]) -> RunConfig:
    return build_config([Layer("run.toml", settings)])


def test_the_words_of_the_rule_flag() -> None:
    words = ["zone.limit=8.3", "zone.edge=a", "plain", "mine:Rule", "my.mod:Rule.limit=2"]
    assert set_plug_ins(words, RULE) == {
        "zone": {"limit": 8.3, "edge": "a"},
        "plain": True,
        "mine:Rule": True,
        "my.mod:Rule": {"limit": 2},
    }
    for bad in (["zone.a=1", "zone.a=2"], ["limit=3"]):
        with pytest.raises(ConfigError, match="--rule "):
            set_plug_ins(bad, RULE)


def test_the_words_of_the_metric_flag_and_the_table_are_alike() -> None:
    named = set_plug_ins(["mine:Metric.limit=2", "mine:Other"], METRIC)
    config = built({"metrics": named | {"mine:Off": False}, "egos": ({}, {"rules": {}})})
    assert [dict(ego.metrics.plugged_in) for ego in config.each_ego()] == [
        {"mine:Metric": {"limit": 2}, "mine:Other": {}}
    ] * 2
    assert tomllib.loads(dump_toml(config))["metrics"] == named
    assert "metrics" not in dump_toml(RunConfig())
    with pytest.raises(ConfigError, match="--metric limit=3: expected a metric"):
        set_plug_ins(["limit=3"], METRIC)
