"""Published curves of injury, and where they hold."""

from __future__ import annotations

import math

import pytest

from giveway.risk.severity import (
    CURVES,
    injury_at_contact,
    monfort_mueller,
    rosen_sander,
    severities,
    tefft,
)

MPH = 1.609344


def test_rosen_and_sander_give_their_published_risks():
    assert rosen_sander(6.9 / 0.090) == pytest.approx(0.5)
    assert rosen_sander(50.0) == pytest.approx(0.083, abs=0.001)
    assert rosen_sander(50.0, age=20.0) < rosen_sander(50.0, age=80.0)


@pytest.mark.parametrize(("speed", "share"), [(24.1, 0.10), (40.6, 0.50), (54.6, 0.90)])
def test_tefft_gives_its_published_points(speed, share):
    assert tefft(speed * MPH) == pytest.approx(share)


def test_monfort_and_mueller_have_their_intercept_at_the_means():
    at_means = {"height": 85.25, "male": 0.59, "age": 42.42}
    assert monfort_mueller(42.79, "MAIS3+", **at_means) == pytest.approx(1 / (1 + math.exp(0.46)))
    assert monfort_mueller(42.79, "death", **at_means) == pytest.approx(1 / (1 + math.exp(3.28)))
    assert monfort_mueller(42.79, "MAIS3+") < monfort_mueller(42.79, "MAIS3+", **at_means)


def test_the_risk_grows_with_the_speed_wherever_a_curve_holds():
    for curve in CURVES:
        risks = [curve.at(speed) for speed in (11.0, 14.0, 17.0, 20.0)]
        assert risks == sorted(risks)
        assert all(0.0 < risk < 1.0 for risk in risks)


def test_outside_of_its_speeds_a_curve_gives_no_number():
    at_20_kmh = {(c.name, c.outcome): c.at(20.0 / 3.6) for c in CURVES}
    assert at_20_kmh.pop(("Rosén & Sander 2009", "death")) == pytest.approx(0.0061, abs=1e-4)
    assert all(math.isnan(risk) for risk in at_20_kmh.values())


ADULT, CHILD = {"adult_impact_speed": 12.0}, {"child_impact_speed": 12.0}


def test_no_curve_holds_for_children_and_adults_get_their_number_beside_them():
    found = severities([ADULT, CHILD, {"adult_impact_speed": None}, {}, ADULT])
    alone = severities([ADULT])
    assert {(one.impacts, one.children, one.valid) for one in found} == {(3, 1, 2)}
    assert [one.mean for one in found] == [one.mean for one in alone]
    assert all(one.holds_for_adults for one in found)
    children = severities([CHILD])
    assert all(math.isnan(one.mean) and not one.holds_for_adults for one in children)


def test_an_injury_is_known_for_adults_within_the_curves_speeds():
    assert injury_at_contact(ADULT) == pytest.approx(monfort_mueller(12.0 * 3.6, "MAIS3+"))
    assert math.isnan(injury_at_contact(ADULT | CHILD))
    assert math.isnan(injury_at_contact({"adult_impact_speed": 5.0}))
