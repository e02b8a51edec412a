"""Levels of service by space."""

import pytest

from giveway.measures import FRUIN, HCM, level_of_service


@pytest.mark.parametrize(
    ("density", "fruin", "hcm"),
    [(0.0, "A", "A"), (0.25, "A", "B"), (0.5, "C", "D"), (1.0, "D", "E"), (2.5, "F", "F")],
)
def test_levels_of_service_by_space(density: float, fruin: str, hcm: str) -> None:
    assert level_of_service(FRUIN, density=density) == fruin
    assert level_of_service(HCM, density=density) == hcm
