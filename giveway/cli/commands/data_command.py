"""The commands ``giveway data describe`` and ``giveway data measure``."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from rich import box
from rich.console import Console
from rich.table import Column, Table

from giveway.cli.screen.printing import escape, numbers_of, print_place, writing
from giveway.cli.screen.recordings import cite, counted, read
from giveway.recordings import Dataset, dataset_of
from giveway.recordings.describing import TOTAL, Described, describe
from giveway.recordings.measuring import Measured, measure
from giveway.results.folder import check_folder

_DESCRIBED = ("recordings.csv", "defects.csv")
_MEASURED = ("vehicles.csv", "people.csv", "summary.csv")
_DECIMALS = 6


def describe_command(
    folder: Path, dataset: str | None, out: Path | None, *, force: bool, quiet: bool
) -> None:
    """Read the recordings, print a row for each, the total and the defects, and write them.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    described = dataset_of(dataset)
    _check(out, _DESCRIBED, force=force)
    recordings = read(console, folder, described)
    with counted(console, "Describing", len(recordings)) as advance:
        found = describe(recordings, advance)
    console.print(_description(found, described))
    if len(found.defects):
        console.print(_defects(found))
    cite(console, described)
    _write(console, out, dict(zip(_DESCRIBED, (found.table, found.defects), strict=True)))


def measure_command(
    folder: Path,
    dataset: str | None,
    vehicle: str | None,
    out: Path | None,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Read the recordings, print a row for each drive and the summary, and write all tables.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    described = dataset_of(dataset)
    _check(out, _MEASURED, force=force)
    recordings = read(console, folder, described)
    with counted(console, "Measuring", len(recordings)) as advance:
        found = measure(recordings, vehicle, advance)
    console.print(_drives(found, described))
    if vehicle is not None and len(found.people):
        console.print(_people(found))
    console.print(_summary(found))
    cite(console, described)
    _write(
        console, out, dict(zip(_MEASURED, (found.drives, found.people, found.summary), strict=True))
    )


def _check(out: Path | None, names: Sequence[str], *, force: bool) -> None:
    if out is not None:
        check_folder(out, force=force, ours=frozenset(names), writer="giveway data")


def _write(console: Console, out: Path | None, tables: Mapping[str, pd.DataFrame]) -> None:
    if out is None:
        return
    for name, table in tables.items():
        with writing(out / name, "name another folder with --out"):
            table.round(_DECIMALS).to_csv(out / name, index=False, lineterminator="\n")
    print_place(console, "Tables", out)


def _description(found: Described, dataset: Dataset) -> Table:
    where = f": {dataset.site}" if dataset.site else ""
    headings = ("people", "moving", "parked", "near", "s", "m/s", "95 %", "gap", "defects")
    caption = (
        "moving, parked: vehicles; near: pairs of a person and a moving vehicle within 4 m; m/s, "
        "95 %: speeds of walking; gap: smallest clearance [m] of a person and a vehicle"
    )
    table = _narrow(_named("recording", *headings), dataset.name + where, caption)
    for row in _rows(found.table):
        if row.recording == TOTAL:
            table.add_section()
        table.add_row(
            escape(str(row.recording)),
            *(str(n) for n in (row.people, row.moving, row.parked, row.encounters)),
            _number(row.duration, 1),
            *(_number(n, 2) for n in (row.walking_speed, row.walking_speed_95, row.smallest_gap)),
            str(row.defects),
        )
    return table


def _defects(found: Described) -> Table:
    table = Table("recording", "defect", *numbers_of("count")[1:], "the first", title="Defects")
    for row in _rows(found.defects):
        texts = (str(row.recording), str(row.defect), str(row.count), str(row.example))
        table.add_row(*(escape(text) for text in texts))
    return table


def _drives(found: Measured, dataset: Dataset) -> Table:
    headings = ("s", "mean", "top", "rest", "jerk", "brake", "near", "close", "tight")
    caption = (
        "mean, top [m/s]; rest: share of time; jerk [m/s3], brake [m/s2]: RMS and hardest; near: "
        "people within 4 m; "
        "close: of these, passed at less than 0.5 m and more than 2 m/s; tight: at less than 0.3 m "
        "and more than 3 m/s"
    )
    columns = _named("recording", "car", *headings)
    table = _narrow(columns, f"Recorded drives, {dataset.name}", caption)
    for row in _rows(found.drives):
        table.add_row(
            escape(str(row.recording)),
            escape(str(row.vehicle)),
            _number(row.duration, 1),
            _number(row.mean_speed, 2),
            _number(row.maximum_speed, 2),
            f"{row.standing:.0%}",
            _number(row.rms_jerk, 2),
            _number(row.peak_deceleration, 2),
            *(str(n) for n in (row.near, row.close, row.tight)),
        )
    return table


def _people(found: Measured) -> Table:
    headings = ("clearance", "at > 2 m/s", "at > 3 m/s", "TTC [s]", "PET [s]")
    columns = _named("recording", "person", *headings)
    caption = "PET: positive if the person was first, negative if the vehicle was"
    table = _narrow(columns, "People within 4 m", caption)
    for row in _rows(found.people):
        table.add_row(
            escape(str(row.recording)),
            escape(str(row.person)),
            *(
                _number(value, 2)
                for value in (
                    row.clearance,
                    row.clearance_above_2,
                    row.clearance_above_3,
                    row.time_to_collision,
                    row.post_encroachment_time,
                )
            ),
        )
    return table


def _summary(found: Measured) -> Table:
    drives = int((found.drives["near"] > 0).sum())
    title = f"Of {len(found.people)} people near {drives} of {len(found.drives)} vehicles"
    caption = (
        "near a moving one: within 4 m while faster than 0.5 m/s; 95 % interval: vehicles resampled"
    )
    columns = numbers_of("people", "share", "near a moving one")
    table = Table(*columns, title=title, caption=escape(caption))
    for of in found.shares:
        moving = _share(of.share_moving, of.low_moving, of.high_moving)
        table.add_row(of.name, str(of.count), _share(of.share, of.low, of.high), moving)
    return table


def _share(share: float, low: float, high: float) -> str:
    if math.isnan(share):
        return "-"  # nobody was near
    interval = "" if math.isnan(low) else f" [{low:.1%}, {high:.1%}]"
    return escape(f"{share:.1%}{interval}")


def _rows(table: pd.DataFrame) -> list[Any]:
    """Return the rows of a table as named tuples."""
    return list(table.itertuples(index=False))


def _named(first: str, *others: str) -> list[Column]:
    """Return the columns of a table: the recording, whose name stays on one line, and numbers."""
    return [Column(first, no_wrap=True), *numbers_of(*others)[1:]]


def _narrow(columns: Sequence[Column], title: str, caption: str) -> Table:
    """Return a table whose columns are one blank apart, so that ten fit into 80 letters."""
    return Table(
        *columns,
        title=escape(title),
        caption=escape(caption),
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
        pad_edge=False,
    )


def _number(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}" if value == value else "-"  # nan is not there
