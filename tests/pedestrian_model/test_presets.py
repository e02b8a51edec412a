"""The presets: published values, and files with their provenance."""

from __future__ import annotations

import pytest

from pedestrian_model import (
    LONGEST_STEP,
    PRESETS,
    SIM,
    TABLE2,
    Crowd,
    CrowdModel,
    Surroundings,
    Vehicles,
    Walls,
    require_steady,
)
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


@pytest.mark.parametrize("name", PRESETS)
def test_nobody_walks_through_a_wall(name) -> None:
    """A wall holds harder than people of the fitted presets accelerate of themselves."""
    model = CrowdModel(PRESETS[name], 0.05)
    wall = Surroundings(Walls.create([[10.0, -20.0, 10.0, 20.0]]))
    crowd = Crowd.create([[0.0, 0.0]], [[1.8, 0.0]], 1.8, [[[50.0, 0.0]]])
    nearest = 10.0
    for _ in range(400):
        model.advance(crowd, Vehicles.empty(), wall)
        nearest = min(nearest, 10.0 - crowd.position[0, 0])
    assert nearest > 0.05
    assert abs(crowd.velocity[0, 0]) < 0.05
