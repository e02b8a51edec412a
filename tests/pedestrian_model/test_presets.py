"""The presets: published values, and files with their provenance."""

from __future__ import annotations

import pytest

from pedestrian_model import LONGEST_STEP, PRESETS, SIM, TABLE2, require_steady
from pedestrian_model.presets import provenance_of

FITTED = ("MIXED", "CITR", "DUT")


def test_the_names_of_the_presets() -> None:
    assert list(PRESETS) == ["SIM", "TABLE2", *FITTED]
    assert (PRESETS["SIM"], PRESETS["TABLE2"]) == (SIM, TABLE2)
    assert provenance_of("SIM") == {}


@pytest.mark.parametrize("name", FITTED)
def test_a_fitted_preset_says_what_it_was_fitted_to(name) -> None:
    origin = provenance_of(name)
    assert origin["made_by"] == "giveway calibrate"
    assert set(origin["datasets"]) == ({"CITR", "DUT"} if name == "MIXED" else {name})
    assert origin["recordings"]
    assert "arXiv 1902.00487" in origin["citations"][0]
    changed = {
        field for field, value in vars(PRESETS[name]).items() if value != getattr(SIM, field)
    }
    assert changed == set(origin["fitted"])


@pytest.mark.parametrize("name", FITTED)
def test_fitted_people_accelerate_as_people_do_and_sway(name) -> None:
    """Of recorded people near cars 95 % of the accelerations are below 1.1 m/s^2."""
    assert 0.8 < PRESETS[name].max_acceleration < 1.4
    assert 0.0 < PRESETS[name].sway < 0.6
    require_steady(PRESETS[name], LONGEST_STEP)
