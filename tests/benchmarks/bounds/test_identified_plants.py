"""A few drawn vehicles are identified as what they are."""

import identified_plants as plants
import pytest


@pytest.mark.parametrize("seed", [27])  # a limit and a pedal that is not linear
def test_drawn_vehicles_are_found(seed):
    row = plants.variant(seed)
    assert row["outcome"] == "found"
    assert row["wrong"] == ""
    assert row["drive_covered"] == row["brake_covered"] == 1


def test_what_is_wrong_is_said():
    truth, _profile, _traits = plants.drawn(27)
    expected = plants.told(truth)
    assert expected["drive"]["limit"] == pytest.approx(truth["drive_limit"] / truth["mass"])
    assert plants.drawn(27)[0] == truth
