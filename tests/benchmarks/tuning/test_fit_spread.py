"""The table of ten fits: what they agree on is identified, and how far a car's force reaches."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from fit_spread import correlated, printed, spread

from pedestrian_model import PRESETS

MIXED = PRESETS["MIXED"]


def test_what_fits_agree_on_is_identified_and_comes_first():
    fits = [
        replace(MIXED, max_acceleration=1.0 + 0.01 * k, vehicle_nose=0.1 * 2.0**k) for k in range(4)
    ]
    table = spread(fits, MIXED)
    assert table.loc["`max_acceleration`", "identified"]
    assert not table.loc["`vehicle_nose`", "identified"]
    assert table.loc["`vehicle_nose`", "deviation"] == pytest.approx(
        math.log(2.0) * math.sqrt(5.0 / 3.0)
    )
    lines = printed(table).splitlines()[2:]
    assert lines[-1].startswith("| `vehicle_nose` | 0.405 | 0.3 | 0.175 to 0.5 | 0.1 to 0.8 |")
    assert lines[-1].endswith("| no |")
    assert all(line.endswith("| yes |") for line in lines[:-1] if "reach" not in line)


def test_a_stronger_car_reaches_farther_and_a_quick_person_is_reached_less():
    reach = [
        spread([each, each], MIXED).loc["reach ahead [m]", "median"]
        for each in (
            MIXED,
            replace(MIXED, vehicle_strength=2.0 * MIXED.vehicle_strength),
            replace(MIXED, max_acceleration=2.0 * MIXED.max_acceleration),
        )
    ]
    nearer = math.log(2.0) / MIXED.vehicle_decay  # the force decays exponentially
    assert reach[1] - reach[0] == pytest.approx(nearer, rel=0.15)
    assert reach[0] - reach[2] == pytest.approx(nearer, rel=0.15)


def test_two_parameters_that_go_together_are_named():
    fits = [
        replace(MIXED, vehicle_strength=1000.0 * 1.1**k, vehicle_decay=1.1 ** (-k), sway=swayed)
        for k, swayed in enumerate((0.1, 0.2, 0.1, 0.2, 0.1))
    ]
    assert correlated(fits) == (
        "1 of 91 pairs beyond 0.63: `vehicle_strength` and `vehicle_decay` -1.00."
    )
