"""Colours and points, beside the kept answers of Euro NCAP's calculator to 200 random tables."""

from __future__ import annotations

import gzip
import json
import sys
from math import nan
from pathlib import Path

import pytest

from giveway.ncap.protocol import PROTOCOLS, read_protocol
from giveway.ncap.rating import bands_of, colour_of, rate, verified

BENCHMARK = Path(__file__).parents[3] / "benchmarks" / "ncap"
sys.path.insert(0, str(BENCHMARK))
from official_points import coverage, differences  # noqa: E402

sys.path.remove(str(BENCHMARK))
KEPT = json.loads(gzip.decompress(Path(__file__).with_name("official_points.json.gz").read_bytes()))
PROTOCOL = read_protocol("euroncap-2026")


def cell(test: str, hit: int, speed: int, protocol=PROTOCOL):
    return next(one for one in protocol.cells if one.key == (test, hit, speed))


def test_colours_verdicts_and_points_are_those_of_the_calculator():
    assert len(KEPT["tables"]) == 200
    assert [found for table in KEPT["tables"] for found in differences(table)] == []


def test_the_kept_tables_have_every_band_verdict_and_step():
    counts = coverage(KEPT["tables"])
    bands = {
        f"{speed} km/h, {colour}"
        for speed in (10, 20, 30, 40, 50)
        for colour, _, _ in bands_of(PROTOCOL, cell("CPNA", 50, speed))
    }
    steps = {f"extended range: {share} % of the points" for share in ("0.0", "100.0")}
    verdicts = {f"verification: {verdict}" for verdict in ("correct", "in tolerance", "incorrect")}
    for what in bands | steps | verdicts | {"CPNA 75 % at 10 km/h red"}:
        assert counts[what] >= 20, what


@pytest.mark.parametrize(
    ("speed", "impact", "colour"),
    [
        (10, nan, "green"),
        (20, 0.01, "red"),
        (30, 9.99, "brown"),
        (30, 10.0, "red"),
        (40, 10.0, "brown"),
        (50, 0.004, "green"),  # 0.00 km/h
        (60, 19.99, "orange"),
        (60, 30.0, "red"),
    ],
)
def test_an_edge_belongs_to_the_worse_band(speed, impact, colour):
    assert colour_of(PROTOCOL, cell("CPNA", 50, speed), impact) == colour


def test_fast_cells_along_the_road_score_avoidance_only():
    assert colour_of(PROTOCOL, cell("CPLA", 25, 60), 5.0) == "yellow"
    assert colour_of(PROTOCOL, cell("CPLA", 25, 70), 5.0) == "red"


def test_a_table_of_green_cells_has_all_points_by_day():
    green = {one.key: "green" for one in PROTOCOL.cells}
    rating = rate(PROTOCOL, green)
    assert (rating.total, rating.most, rating.zeroed) == (3.375, 3.375, False)


def test_the_cell_that_all_points_need_zeroes_them():
    """The calculator's text says so; its version 5.4.9 does not do it (docs/ncap.md)."""
    colours = {one.key: "green" for one in PROTOCOL.cells} | {("CPNA", 75, 10): "red"}
    assert (rate(PROTOCOL, colours).total, rate(PROTOCOL, colours).zeroed) == (0.0, True)
    assert rate(PROTOCOL, colours, zeroes=False).total == pytest.approx(3.375 - 0.5 / 18, abs=1e-3)


def test_a_tolerance_of_2_km_h_confirms_a_colour_but_no_green_that_was_hit_harder():
    where = cell("CPNA", 50, 60)
    assert verified(PROTOCOL, where, "yellow", 11.99) == ("in tolerance", "yellow")
    assert verified(PROTOCOL, where, "yellow", 12.0) == ("incorrect", "orange")
    assert verified(PROTOCOL, where, "orange", 8.0) == ("in tolerance", "orange")
    assert verified(PROTOCOL, where, "orange", 7.99) == ("better", "yellow")
    assert verified(PROTOCOL, where, "green", 1.99) == ("in tolerance", "green")
    assert verified(PROTOCOL, where, "yellow", 0.0) == ("better", "green")


def test_r152_allows_impact_speeds_by_the_speed_of_the_test():
    protocol = read_protocol("r152")
    for speed, allowed in ((40, 0.0), (42, 10.0), (60, 35.0)):
        where = cell("R152", 50, speed, protocol)
        assert colour_of(protocol, where, allowed) == "green"
        assert colour_of(protocol, where, allowed + 0.01) == "red"


@pytest.mark.parametrize("name", PROTOCOLS)
def test_every_protocol_can_be_read_and_names_what_is_not_tested(name):
    protocol = read_protocol(name)
    assert len({one.key for one in protocol.cells}) == len(protocol.cells) > 7
    assert all(one.test.dummy in protocol.dummies for one in protocol.cells)
    assert protocol.untested
