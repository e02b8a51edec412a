"""The worst motion of people, by its name in the table of the safety layer."""

import pytest

from giveway.config import EgoRunConfig
from giveway.ego.people_assumed import people_at_worst
from giveway.errors import ConfigError
from pedestrian_model import HELD, PRESETS, SIM


def worst_case_of(**crowd) -> EgoRunConfig:
    return EgoRunConfig.model_validate({"crowd": crowd, "safety": {"people": "worst-case"}})


@pytest.mark.parametrize("preset", PRESETS)
def test_the_worst_case_is_what_walls_and_signals_hold_people_with(preset: str) -> None:
    worst = people_at_worst(worst_case_of(preset=preset))
    assert worst.acceleration == HELD >= PRESETS[preset].max_acceleration
    assert worst.speed == PRESETS[preset].max_speed


def test_the_worst_case_of_another_model_is_what_it_allows() -> None:
    worst = people_at_worst(worst_case_of(preset="MIXED", model="social-force"))
    assert worst.acceleration == SIM.max_acceleration


def test_a_preset_that_is_not_there_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.toml"):
        people_at_worst(worst_case_of(preset="nowhere.toml"))
