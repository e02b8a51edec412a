"""Cells and tables of a report."""

import math

from giveway.reports.tables.table import Cell, Table, number_cell, verdict_cell, whole_cell


def test_a_missing_number_is_marked_as_such() -> None:
    assert number_cell(1.234) == Cell("1.23", "number")
    assert number_cell(math.nan) == Cell("N.A.", "na")


def test_a_whole_number_may_come_as_a_float_or_a_text() -> None:
    assert [whole_cell(value).text for value in (12000, 12000.0, "12000.0")] == ["12,000"] * 3


def test_only_better_and_worse_have_a_colour() -> None:
    assert verdict_cell("better").kind == "better"
    assert verdict_cell("worse").kind == "worse"
    assert verdict_cell("no difference shown").kind == "none"


def test_a_column_is_numeric_if_all_its_cells_are() -> None:
    rows = [
        (Cell("mpc"), number_cell(1.0), number_cell(1.0)),
        (Cell("pid"), number_cell(math.nan), Cell("none")),
    ]
    assert Table("t", "A table.", ("a", "b", "c"), rows).numeric == [False, True, False]
    assert Table("t", "A table.", ("a",), ()).numeric == [False]
