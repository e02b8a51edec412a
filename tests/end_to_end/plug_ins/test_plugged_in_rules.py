"""A rule of the road of another package holds: as docs/plugins.md prints it, in real runs."""

from __future__ import annotations

import json
import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.plug_ins import installed, printed  # noqa: F401 - a fixture

import giveway
from giveway.cli.commands.check_command import check_command
from giveway.errors import ConfigError, ControlError, RuleError
from giveway.plug_ins.sockets import RULE

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RUN: dict[str, Any] = {"scenario": "street", "crowd": {"zone": "none"}, "time_limit": 12.0}
BROKEN = """
class Broken:
    def __init__(self, route):
        pass

    def demand(self, situation):
        {body}
"""


@pytest.fixture
def school(installed: Callable[..., Path]) -> None:  # noqa: F811
    points = tomllib.loads(printed("file: school pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points["giveway.rules"].items()
    text = printed("file: school_zone.py")
    installed("school_zone", text, declares=f"{name} = {value}", group="giveway.rules")


def speeds(**settings: Any) -> np.ndarray:
    return giveway.run(RUN | settings).ego_track.speed


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "mpc-paper"])
def test_the_printed_rule_slows_the_ego(school: None, controller: str) -> None:
    rules = tomllib.loads(printed("school run"))["rules"]
    rules["school-zone"]["limit"] = 3.0
    own = {"controller": controller, "regulation": {"reference_speed": 8.0}}
    assert speeds(**own).max() > 6.0
    assert speeds(**own, rules=rules)[100:].max() < 3.5


def test_out_of_its_hours_it_demands_nothing(school: None) -> None:
    rules = {"school-zone": {"edge": "eastbound", "limit": 3.0}}
    assert np.array_equal(speeds(rules=rules), speeds())


def test_the_manifest_and_config_name_it(school: None, tmp_path: Path) -> None:
    rules = {"school-zone": {"edge": "eastbound", "begin": 0.0}}
    giveway.run(RUN | {"rules": rules, "time_limit": 1.0}, results=tmp_path / "run", pictures=False)
    (told,) = json.loads((tmp_path / "run" / "manifest.json").read_text())["rules"].values()
    assert (told["name"], told["distribution"]) == ("school-zone", "school-zone")
    assert told["options"]["begin"] == 0.0
    config = tomllib.loads((tmp_path / "run" / "config.toml").read_text())
    assert config["rules"]["school-zone"] == rules["school-zone"]
    again = giveway.run(str(tmp_path / "run" / "config.toml"))
    assert len(again.ego_track.time) > 1


def test_the_printed_rule_is_sound(school: None, capsys: pytest.CaptureFixture[str]) -> None:
    assert check_command("school-zone", ["edge=second"], RULE) == 0
    assert "school-zone: sound" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("return 3.0", "returned 3.0: expected a Demand, or None"),
        ("raise ValueError('no')", "raised ValueError: no"),
        (
            "from giveway.ego.rules.protocol import Demand; return Demand(50.0)",
            "expected a word as the cause of the stop",
        ),
        (
            "from giveway.ego.rules.protocol import Demand; return Demand(speed=float('nan'))",
            "expected a number as speed",
        ),
    ],
)
def test_a_fault_names_rule_ego_and_step(
    installed: Callable[..., Path],  # noqa: F811
    body: str,
    said: str,
) -> None:
    installed("broken", BROKEN.format(body=body))
    with pytest.raises(RuleError, match=r"rule at step 0: 'broken:Broken' of 'ego' ") as caught:
        giveway.run(RUN | {"rules": {"broken:Broken": True}})
    assert said in str(caught.value)
    assert check_command("broken:Broken", [], RULE) == 1


def test_unknown_names_and_options_are_refused_in_words(school: None) -> None:
    with pytest.raises(ConfigError, match="did you mean 'school-zone'"):
        giveway.run(RUN | {"rules": {"school-zon": True}})
    with pytest.raises(ConfigError, match="'school-zone' has no such option; did you mean 'edge'"):
        giveway.run(RUN | {"rules": {"school-zone": {"edg": "x"}}})
    with pytest.raises(ControlError, match="no installed package has the module 'nowhere'"):
        giveway.run(RUN | {"rules": {"nowhere:Rule": True}})


def test_a_results_folder_alone_imports_no_module(school: None, tmp_path: Path) -> None:
    rules = {"school_zone:SchoolZone": {"edge": "eastbound"}}
    giveway.run(RUN | {"rules": rules, "time_limit": 1.0}, results=tmp_path / "run", pictures=False)
    with pytest.raises(ConfigError, match="--rule school_zone:SchoolZone"):
        giveway.run(str(tmp_path / "run" / "config.toml"))
