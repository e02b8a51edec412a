"""The table of a protocol's cells: impact speeds, colours and points, and how each was braked."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isnan, nan
from pathlib import Path

import pandas as pd

from giveway.geometry.bodies import BODY
from giveway.ncap.plan import HOLDER, Planned
from giveway.ncap.protocol import KMH, Cell, Colour, Protocol, Test
from giveway.ncap.rating import Key, Rating, Verdict, colour_of, rate, verified
from giveway.run_data.columns import Column
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.lock import NCAP_FILES
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.record import RunRecord

FALSE_REACTION = 0.5
"""Deceleration [m/s^2] without a person that counts as a reaction to nobody."""
NOBODY = "nobody"
"""Name of the rows without a person."""

COLUMNS = (
    Column("driver", "string", None, "controller that drove"),
    Column("test", "string", None, "name of the test; nobody: without a person"),
    Column("hit_point", "integer", "%", "of the car's width, from the person's side; 0: nobody"),
    Column("speed", "integer", "km/h", "speed of the test"),
    Column("range", "string", None, "standard or extended; empty: nobody"),
    Column("impact_speed", "number", "km/h", "of the car, front at the dummy; 0: never"),
    Column("relative_speed", "number", "km/h", "the same relative to the dummy; coloured by it"),
    Column("colour", "string", None, "green, yellow, orange, brown, red; failed: without a result"),
    Column("points", "number", None, "share of the test's points; empty: not rated, or extended"),
    Column("cell", "string", None, "id of the run in this folder"),
    Column("first_sight_distance", "number", "m", "from the front when first perceived"),
    Column("first_sight_time", "number", "s", "from departure until then; empty: never"),
    Column("first_braking_time", "number", "s", "from departure until it brakes with 1 m/s²"),
    Column("hardest_braking", "number", "m/s^2", "largest deceleration before the impact"),
    Column("impact_point", "number", "%", "of the car's width, as the hit point; empty: no impact"),
    Column("measured_speed", "number", "km/h", "as relative_speed, measured; empty: not measured"),
    Column("verdict", "string", None, "correct, in tolerance, better, incorrect; empty: none"),
    Column("failure", "string", None, "why there is no result"),
    Column("repeat", "string", None, "command that makes the run again"),
)


@dataclass(frozen=True)
class Outcome:
    """The outcome of one run of a table.

    Attributes:
        planned: The run.
        id: Id of the run in the study.
        impact: Impact speed [km/h]; 0 without an impact, nan without a result.
        relative: The same relative to the dummy.
        colour: Colour; empty without a person or a result.
        numbers: Other numbers, by column; nan where there is none.
        failure: Reason for which there is no result; empty with one.
    """

    planned: Planned
    id: str
    impact: float
    relative: float
    colour: Colour | str
    numbers: dict[str, float]
    failure: str = ""

    @property
    def reacts_to_nobody(self) -> bool:
        """True if it brakes though nobody is there."""
        return self.planned.cell is None and self.numbers["hardest_braking"] > FALSE_REACTION


@dataclass(frozen=True)
class DriverTable:
    """The outcomes of one driver.

    Attributes:
        protocol: Protocol.
        driver: Controller that drove.
        cells: Outcomes of cells by their keys.
        nobody: Outcomes without a person.
        measured: Impact speeds [km/h] that were measured elsewhere, relative to the dummy.
    """

    protocol: Protocol
    driver: str
    cells: dict[Key, Outcome]
    nobody: tuple[Outcome, ...]
    measured: Mapping[Key, float] = field(default_factory=dict)

    @property
    def tests(self) -> tuple[Test, ...]:
        """The tests of which any cell was run."""
        run = {name for name, *_ in self.cells}
        return tuple(test for test in self.protocol.tests if test.name in run)

    @property
    def rating(self) -> Rating | None:
        """The points, or None if the protocol has none or a cell was not run or has no result."""
        known = {key: one.colour for key, one in self.cells.items() if one.colour}
        if not self.protocol.rates or len(known) < len(self.protocol.cells):
            return None
        return rate(self.protocol, known, list(self.verdicts.items()))  # type: ignore[arg-type]

    @property
    def verdicts(self) -> dict[Key, Verdict]:
        """The verdicts on the colours of those cells whose impact speeds were measured."""
        found: dict[Key, Verdict] = {}
        for key, one in self.cells.items():
            cell = one.planned.cell
            if key in self.measured and one.colour and cell is not None:
                value = self.measured[key]
                found[key], _ = verified(self.protocol, cell, one.colour, value)  # type: ignore[arg-type]
        return found


def outcomes_of(
    study: StudyFolder, protocol: Protocol, runs: Iterable[Planned], width: float | None
) -> list[Outcome]:
    """Return the outcome of each run, in the order of the study's cells.

    Args:
        study: Study of the runs.
        protocol: Protocol.
        runs: Runs, as they were planned.
        width: Width [m] of the car, or None for the default body.
    """
    records = {cell.number: record for cell, _, record in study.records}
    seed = study.seeds[0]
    return [
        outcome_of(protocol, run, f"c{number}-s{seed}", records.get(number), width or BODY.width)
        for number, run in enumerate(runs, start=1)
    ]


_NUMBERS = ("first_sight_distance", "first_sight_time", "first_braking_time", "hardest_braking")


def outcome_of(
    protocol: Protocol, run: Planned, id_: str, record: RunRecord | None, width: float
) -> Outcome:
    """Return the outcome of one run.

    Args:
        protocol: Protocol.
        run: Run, as it was planned.
        id_: Id of the run in its study.
        record: Record of the run, or None if it was not made.
        width: Width [m] of the car.
    """
    if record is None or record.failed or not record.rows:
        reason = "was not made" if record is None else record.failure
        unknown = dict.fromkeys((*_NUMBERS, "impact_point"), nan)
        return Outcome(run, id_, nan, nan, "", unknown, reason)
    row = {key: float(value) for key, value in record.rows[0].items() if _is_number(value)}
    impact, relative = (
        0.0 if isnan(row[name]) else round(KMH * row[name], 2)
        for name in ("dummy_impact_speed", "dummy_relative_speed")
    )
    numbers = {name: round(row[name], 3) + 0.0 for name in _NUMBERS}
    numbers["impact_point"] = nan
    if run.cell is None:
        return Outcome(run, id_, impact, relative, "", numbers)
    numbers["impact_point"] = round(
        _hit_by(protocol, run.cell, row["dummy_lateral_offset"], width), 3
    )
    colour = colour_of(protocol, run.cell, relative)
    return Outcome(run, id_, impact, relative, colour, numbers)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)


def _hit_by(protocol: Protocol, cell: Cell, aside: float, width: float) -> float:
    """Return the place [%] of the dummy's reference point on the car's front.

    Args:
        protocol: Protocol.
        cell: Cell.
        aside: Place [m] of the box's middle to the left of the front's middle; nan stays.
        width: Width [m] of the car.
    """
    test = cell.test
    away = -test.comes_from * aside
    if test.walks != "along":
        away -= protocol.dummy(test).reference
    return 100.0 * (0.5 + away / width)


def tables_of(
    protocol: Protocol, outcomes: Iterable[Outcome], measured: Mapping[Key, float] | None = None
) -> list[DriverTable]:
    """Return the tables, driver by driver.

    Args:
        protocol: Protocol.
        outcomes: Outcomes of all runs.
        measured: Impact speeds [km/h] that were measured elsewhere; they verify the first table.
    """
    by_driver: dict[str, list[Outcome]] = {}
    for one in outcomes:
        by_driver.setdefault(one.planned.driver, []).append(one)
    return [
        DriverTable(
            protocol,
            driver,
            {one.planned.cell.key: one for one in mine if one.planned.cell is not None},
            tuple(one for one in mine if one.planned.cell is None),
            measured or {} if driver == HOLDER else {},
        )
        for driver, mine in by_driver.items()
    ]


def write_ncap(out: Path, tables: Iterable[DriverTable]) -> pd.DataFrame:
    """Write ``ncap.csv`` into the study's folder, and return it."""
    rows = [_row(table, one, out) for table in tables for one in _all(table)]
    frame = pd.DataFrame(rows, columns=[column.name for column in COLUMNS])
    write_atomically(out / NCAP_FILES[0], frame.to_csv(index=False, lineterminator="\n"))
    return frame


def _all(table: DriverTable) -> tuple[Outcome, ...]:
    return (*table.cells.values(), *table.nobody)


def _row(table: DriverTable, one: Outcome, out: Path) -> list[object]:
    cell, run = one.planned.cell, one.planned
    where = [NOBODY, 0, run.speed, ""]
    if cell is not None:
        where = [*cell.key, "extended" if cell.extended else "standard"]
    numbers = [one.numbers[name] for name in (*_NUMBERS, "impact_point")]
    return [
        run.driver,
        *where,
        one.impact,
        one.relative,
        "failed" if one.failure else one.colour,
        points_of(table.protocol, one),
        one.id,
        *numbers,
        table.measured.get(cell.key, nan) if cell is not None else nan,
        table.verdicts.get(cell.key, "") if cell is not None else "",
        one.failure,
        f"giveway rerun {shlex.quote(str(out))} {one.id}",
    ]


def points_of(protocol: Protocol, one: Outcome) -> float:
    """Return the share of a standard cell in its test's points; nan for any other one."""
    cell = one.planned.cell
    if cell is None or cell.extended or not one.colour or not protocol.rates:
        return nan
    standard = [each for each in protocol.cells if each.test is cell.test and not each.extended]
    share = protocol.colours.points[one.colour] / len(standard)  # type: ignore[index]
    return round(cell.test.standard_points * share, 6)
