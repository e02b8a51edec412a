"""The page of a table of consumer tests: a matrix for each test, its points, and what it is not."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan

from giveway.ncap.protocol import Protocol, Test
from giveway.ncap.table import DriverTable, Outcome
from giveway.reports.report_page import page_environment


@dataclass(frozen=True)
class Square:
    """One cell of a matrix.

    Attributes:
        text: Speed of impact [km/h]; empty where the protocol has no cell.
        letter: First letter of the colour, for print in black and white.
        colour: Colour; empty for none.
        extended: True if it belongs to the extended range.
        told: Other numbers and the id of the run.
    """

    text: str = ""
    letter: str = ""
    colour: str = ""
    extended: bool = False
    told: str = ""


@dataclass(frozen=True)
class Matrix:
    """The matrix of one test: its rows are hit points, its columns speeds."""

    name: str
    title: str
    points: str
    speeds: Sequence[int]
    rows: Sequence[tuple[str, Sequence[Square]]]


def matrices_of(table: DriverTable) -> list[Matrix]:
    """Return the matrices of a driver, test by test, and that without a person."""
    found = [_matrix(table, test) for test in table.tests]
    speeds = sorted({one.planned.speed for one in table.nobody})
    roads = dict.fromkeys(one.planned.road for one in table.nobody)
    rows = [(road, [_alone(table, road, speed) for speed in speeds]) for road in roads]
    found.append(
        Matrix("False reaction", "largest deceleration [m/s²] without the person", "", speeds, rows)
    )
    return found


def _matrix(table: DriverTable, test: Test) -> Matrix:
    speeds = sorted({speed for name, _, speed in table.cells if name == test.name})
    hits = sorted({hit for name, hit, _ in table.cells if name == test.name})
    rows = [
        (f"{hit} %", [_square(table.cells.get((test.name, hit, speed))) for speed in speeds])
        for hit in hits
    ]
    return Matrix(test.name, test.title, points_text(table, test), speeds, rows)


def points_text(table: DriverTable, test: Test) -> str:
    """Return the points of a test in words; empty if it has none."""
    rating = table.rating
    if rating is None:
        return ""
    points = rating.tests[test.name]
    return (
        f"{points.standard:.4g} of {test.standard_points:g} points, and {points.extended:.4g} of "
        f"{test.extended_points:g} in the extended range"
    )


def _square(one: Outcome | None) -> Square:
    if one is None:
        return Square()
    assert one.planned.cell is not None
    extended = one.planned.cell.extended
    if one.failure:
        return Square("failed", "!", "failed", extended, f"{one.id}: {one.failure}")
    return Square(f"{one.relative:.1f}", one.colour[0].upper(), one.colour, extended, _told(one))


def _alone(table: DriverTable, road: str, speed: int) -> Square:
    for one in table.nobody:
        if (one.planned.road, one.planned.speed) == (road, speed):
            if one.failure:
                return Square("failed", "!", "failed", told=f"{one.id}: {one.failure}")
            braking = f"{one.numbers['hardest_braking']:.1f}"
            bad = one.reacts_to_nobody
            return Square(braking, "R" if bad else "G", "red" if bad else "green", told=_told(one))
    return Square()


def _told(one: Outcome) -> str:
    numbers = one.numbers
    parts = [
        ("first seen from", numbers["first_sight_distance"], "m"),
        ("brakes", numbers["first_braking_time"] - numbers["first_sight_time"], "s later"),
        ("with", numbers["hardest_braking"], "m/s²"),
        ("hit at", numbers["impact_point"], "% of the width"),
    ]
    told = [f"{what} {value:.2f} {unit}" for what, value, unit in parts if not isnan(value)]
    return f"{one.id}: {', '.join(told)}"


def lead_of(table: DriverTable) -> str:
    """Return the result of a driver in one sentence."""
    rating = table.rating
    failed = [one.id for one in table.cells.values() if one.failure]
    if failed:
        return f"No points, since there is no result of {len(failed)} ({', '.join(failed[:5])})."
    hit = [one for one in table.cells.values() if one.impact > 0.0]
    told = f"Impacts in {len(hit)} of {len(table.cells)} cells"
    if hit:
        told += f", the fastest at {max(one.impact for one in hit):.1f} km/h"
    if rating is None:
        return f"{told}."
    zeroed = ", because the cell that all points need is not green" if rating.zeroed else ""
    checks = f" after {len(table.verdicts)} verified cells" if table.verdicts else ""
    return f"{told}: {rating.total:g} of {rating.most:g} points by day{checks}{zeroed}."


def reactions_of(table: DriverTable) -> str:
    """Return the roads and speeds at which a driver brakes for nobody; empty without any."""
    found: dict[str, list[str]] = {}
    for one in table.nobody:
        if one.reacts_to_nobody:
            found.setdefault(one.planned.road, []).append(str(one.planned.speed))
    return "; ".join(f"{road} at {', '.join(speeds)} km/h" for road, speeds in found.items())


def verification_of(table: DriverTable) -> list[tuple[str, str, str, str]]:
    """Return each measured cell: its name, its impact speeds [km/h] here and there, the verdict."""
    rows: list[tuple[str, str, str, str]] = []
    for key, verdict in table.verdicts.items():
        one = table.cells[key]
        assert one.planned.cell is not None
        speeds = f"{one.relative:.1f}", f"{table.measured[key]:.1f}"
        rows.append((one.planned.cell.label, *speeds, verdict))
    return rows


def ncap_page(
    protocol: Protocol,
    tables: Sequence[DriverTable],
    facts: Sequence[tuple[str, str]],
    footer: str,
) -> str:
    """Return the page as HTML.

    Args:
        protocol: Protocol.
        tables: Tables, that of the tests' driver first.
        facts: Facts about the car and its perception.
        footer: Origin of the page.
    """
    template = page_environment().get_template("ncap.html.j2")
    drivers = [
        {
            "heading": "" if number == 0 else f"Not a Euro NCAP rating: {table.driver} drives",
            "lead": lead_of(table),
            "matrices": matrices_of(table),
            "verified": verification_of(table),
            "false": reactions_of(table),
        }
        for number, table in enumerate(tables)
    ]
    return template.render(protocol=protocol, drivers=drivers, facts=facts, footer=footer)
