"""Numbers, units and ids in a report's words."""

import math

from giveway.reports.wording import counted, interval, quantity, share, shown_ego


def test_an_ego_is_named_unless_it_is_the_usual_one() -> None:
    assert shown_ego("bus1") == " (ego bus1)"
    assert shown_ego("ego") == shown_ego("") == ""


def test_counts_have_a_plural_and_commas() -> None:
    assert counted(1, "run") == "1 run"
    assert counted(2000, "run") == "2,000 runs"
    assert counted(0, "pair") == "0 pairs"


def test_a_quantity_has_its_unit_unless_it_is_missing() -> None:
    assert quantity(-0.574, "s") == "−0.57 s"
    assert quantity(1.0, "m/s^2", 1) == "1.0 m/s²"
    assert quantity(math.nan, "s") == "N.A."


def test_an_interval_has_as_many_digits_as_its_width_needs() -> None:
    assert interval(-0.84, -0.31, "s") == "−0.84 to −0.31 s"
    assert interval(10.0, 70.0) == "10 to 70"
    assert interval(math.nan, 1.0) == "–"


def test_a_share_is_in_per_cent() -> None:
    assert share(0.125) == "12.5 %"
    assert share(math.nan) == "–"
