"""The line that mends a gain, as a user is told to write it."""

import pytest

from fmus.profile.advice import gain_line


def test_without_a_profile_the_gain_is_the_factor() -> None:
    assert gain_line(None, "inputs", "force", -1.0) == "`gain = -1.0` in [inputs.force]"


@pytest.mark.parametrize(("factor", "written"), [(1000.0, "1000.0"), (1 / 3.6, "0.277778")])
def test_six_digits_are_written(factor: float, written: str) -> None:
    assert gain_line(None, "outputs", "speed", factor, "") == f"gain = {written} in [outputs.speed]"
