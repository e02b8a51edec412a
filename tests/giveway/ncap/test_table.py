"""The table of outcomes: rows, points, verdicts, and its page."""

from __future__ import annotations

from math import isnan, nan

import pytest

from giveway.ncap.plan import HOLDER, OPEN, Planned, runs_of
from giveway.ncap.protocol import read_protocol
from giveway.ncap.table import Outcome, outcome_of, points_of, tables_of, write_ncap
from giveway.reports.ncap_page import lead_of, ncap_page, verification_of
from giveway.studies.record import RunRecord

PROTOCOL = read_protocol("euroncap-2026")
BRAKED = {
    "first_sight_time": 1.0,
    "first_sight_distance": 20.0,
    "first_braking_time": 1.3,
    "hardest_braking": 7.0,
}


def cell(test, hit, speed):
    return next(one for one in PROTOCOL.cells if one.key == (test, hit, speed))


def run_of(where):
    return Planned(where.label, HOLDER, OPEN, where.speed, where)


def measured(where, speed=nan, aside=nan, width=1.8):
    row = {
        "ego": "ego",
        "dummy_impact_speed": speed,
        "dummy_relative_speed": speed,
        "dummy_lateral_offset": aside,
        **BRAKED,
    }
    record = RunRecord("c1-s1", "key", "completed", (row,))
    return outcome_of(PROTOCOL, run_of(where), "c1-s1", record, width)


def table(drivers=(HOLDER,), **colours):
    """A whole table in which each cell is avoided but those of ``colours``."""
    found = []
    for number, run in enumerate(runs_of(PROTOCOL.cells, drivers), start=1):
        key = None if run.cell is None else "{}_{}_{}".format(*run.cell.key)
        impact = colours.get(key, 0.0)
        colour = "" if run.cell is None else "green" if not impact else "orange"
        numbers = BRAKED | {"impact_point": nan}
        if run.cell is None:
            numbers = numbers | {"hardest_braking": 0.1}
        found.append(Outcome(run, f"c{number}-s1", impact, impact, colour, numbers))
    return found


def test_the_impact_point_counts_from_the_side_of_the_person():
    """The box's middle is 0.06 m beyond the reference point."""
    near = measured(cell("CPNA", 25, 50), 10.0, -0.45 + 0.06)
    far = measured(cell("CPFA", 25, 50), 10.0, 0.45 - 0.06)
    along = measured(cell("CPLA", 25, 50), 10.0, -0.45)
    for found in (near, far, along):
        assert found.numbers["impact_point"] == pytest.approx(25.0)
        assert found.impact == found.relative == 36.0
    assert near.colour == "red"


def test_no_impact_is_green_and_has_no_impact_point():
    found = measured(cell("CPNA", 25, 50))
    assert (found.impact, found.colour) == (0.0, "green")
    assert isnan(found.numbers["impact_point"])


def test_a_run_without_a_result_has_no_colour_and_the_table_no_points():
    where = cell("CPNA", 25, 50)
    record = RunRecord("c1-s1", "key", "crashed", failure="car.fmu: segmentation fault")
    found = outcome_of(PROTOCOL, run_of(where), "c1-s1", record, 1.8)
    assert (found.colour, found.failure) == ("", "car.fmu: segmentation fault")
    whole = [one if one.planned.cell is not where else found for one in table()]
    (driven,) = tables_of(PROTOCOL, whole)
    assert driven.rating is None
    assert lead_of(driven) == "No points, since there is no result of 1 (c1-s1)."


def test_points_of_standard_cells_add_up_to_those_of_the_test():
    (driven,) = tables_of(PROTOCOL, table())
    each = {
        extended: [
            points_of(PROTOCOL, one)
            for one in driven.cells.values()
            if one.planned.cell.extended == extended
        ]
        for extended in (False, True)
    }
    assert sum(each[False]) == pytest.approx(3.0, abs=1e-4)
    assert all(map(isnan, each[True]))
    assert driven.rating.total == 3.375


def test_measured_speeds_verify_the_first_table_and_cost_points():
    told = {("CPNA", 50, 60): 1.0, ("CPNA", 25, 60): 0.0, ("CPFA", 50, 60): 25.0}
    first, second = tables_of(PROTOCOL, table((HOLDER, "mpc")), told)
    assert list(first.verdicts.values()) == ["correct", "in tolerance", "incorrect"]
    assert second.verdicts == {}
    assert first.rating.tests["CPFA"].standard == 0.0
    assert first.rating.tests["CPNA"].standard == 0.5
    assert verification_of(first)[2] == ("CPFA 50 % 60 km/h", "0.0", "25.0", "incorrect")
    assert lead_of(first).endswith("2.875 of 3.375 points by day after 3 verified cells.")


def test_the_page_and_the_csv_have_every_cell(tmp_path):
    tables = tables_of(PROTOCOL, table((HOLDER, "mpc"), CPNCO_50_60=15.0))
    frame = write_ncap(tmp_path, tables)
    assert len(frame) == 2 * (110 + 14)
    assert frame["repeat"].iloc[-1] == f"giveway rerun {tmp_path} c248-s1"
    page = ncap_page(PROTOCOL, tables, [("car", "<b>.fmu")], "made by a test")
    assert page.count('class="green') == 2 * (109 + 14)
    assert page.count('class="orange') == 2
    assert "Not a Euro NCAP rating: mpc drives" in page
    assert "&lt;b&gt;.fmu" in page
    for what, _ in PROTOCOL.untested:
        assert what in page


def test_braking_for_nobody_is_said(tmp_path):
    rows = [
        one
        if one.planned.cell
        else Outcome(one.planned, one.id, 0.0, 0.0, "", one.numbers | {"hardest_braking": 2.0})
        for one in table()
    ]
    page = ncap_page(PROTOCOL, tables_of(PROTOCOL, rows), [], "")
    assert (
        "It brakes though nobody is there: open road at 10, 20, 30, 40, 50, 60, 70, 80 km/h;"
        in page
    )
    assert page.count('class="red"') == 14
