"""What follows from a run's settings: what the controllers declare, unless the user says else."""

from __future__ import annotations

import pytest

from giveway.config.run_settings import RunSettings
from giveway.errors import ConfigError


def test_rules_of_priority_are_the_controllers_matter_unless_set() -> None:
    for controller, heeds in (("mpc", True), ("mpc-paper", False)):
        settings = RunSettings(controller=controller)
        assert settings.heeds("crossings") is heeds
        assert settings.heeds("following") is True
        settings = RunSettings(controller=controller, rules={"crossings": not heeds})
        assert settings.heeds("crossings") is not heeds


def test_lanes_say_how_fast_unless_a_number_does() -> None:
    assert RunSettings().reference_speed == "lane"
    assert RunSettings().heeds("speed_limits")
    slow = RunSettings(regulation={"reference_speed": 3.0})
    assert slow.reference_speed == 3.0
    assert not slow.heeds("speed_limits")


def test_a_controller_has_a_name_for_titles_and_one_for_tables() -> None:
    assert RunSettings(controller="pid-tuned").driver == "PID-TUNED"
    assert RunSettings(controller="some.package:Class").driver == "some.package:Class"
    assert RunSettings(controller="folder/mine.fmu").controller_name == "mine.fmu"
    styled = RunSettings(controller_options={"style": "careful"})
    assert styled.described_controller == "mpc style=careful"
    assert styled.controller_name == RunSettings().described_controller == "mpc"


def test_options_of_a_model_are_the_defaults_while_another_one_moves_people() -> None:
    assert RunSettings(crowd={"model": "orca"}).vci_options == RunSettings().vci_options
    odd = RunSettings(model_options={"detuor": False})
    with pytest.raises(ConfigError, match="did you mean 'detour'"):
        odd.vci_options  # noqa: B018
