"""The worst motion of people, by its name in the table of the safety layer."""

import pytest

from giveway.ego.people_assumed import people_at_worst
from giveway.errors import ConfigError
from pedestrian_model import SIM


def test_the_worst_case_is_what_the_preset_allows() -> None:
    worst = people_at_worst("worst-case", "SIM")
    assert worst.acceleration == SIM.max_acceleration
    assert worst.speed == SIM.max_speed


def test_a_preset_that_is_not_there_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.toml"):
        people_at_worst("worst-case", "nowhere.toml")
