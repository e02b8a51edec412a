"""Tables whose keys are names of plug-ins."""

import pytest
from pydantic import ValidationError

from giveway.config.tables.metrics import MetricsConfig
from giveway.config.tables.rules import RulesConfig


def test_what_is_switched_on_has_its_options() -> None:
    table = MetricsConfig(**{"a.b:Near": {"radius": 2.0}, "a.b:Far": True, "a.b:Off": False})
    assert table.plugged_in == {"a.b:Near": {"radius": 2.0}, "a.b:Far": {}}


def test_an_empty_table_names_a_plug_in_with_its_default_options() -> None:
    assert MetricsConfig(**{"a.b:Near": {}}).plugged_in == {"a.b:Near": {}}


def test_giveways_own_keys_are_no_plug_ins() -> None:
    assert RulesConfig(crossings=False, **{"a.b:Rule": True}).plugged_in == {"a.b:Rule": {}}


def test_a_name_that_nobody_has_is_answered_with_the_one_meant() -> None:
    with pytest.raises(ValidationError, match=r"crosings: no rule.*did you mean 'crossings'"):
        RulesConfig(crosings=True)
