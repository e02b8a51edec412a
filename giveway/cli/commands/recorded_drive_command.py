"""The commands ``giveway data scenario`` and ``giveway data compare``."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.table import Table

from giveway.cli.screen.printing import escape, numbers_of, print_place, writing
from giveway.recordings.clips import clip_at
from giveway.recordings.describing import parked
from giveway.recordings.replacing import scenario_for
from giveway.results.folder import check_folder
from giveway.results.recorded_drive import MEASURES, compared

_TABLE = "compared.csv"
_WRITER = "giveway data"
_PEOPLE = {"near", "close", "person_first", "vehicle_first", "touched", "unaware"}
_COUNTS = frozenset({*_PEOPLE, "short_ttc", "short_pet"})


def scenario_command(
    folder: Path,
    dataset: str | None,
    clip: str,
    vehicle: str | None,
    out: Path,
    *,
    force: bool,
    quiet: bool,
) -> None:
    """Write the scenario, and print the command that runs it.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    recording = clip_at(folder, dataset, clip, str(folder))
    named = dataset or ""  # without a name, no recording was read
    described = str(Path(named).absolute()) if named.endswith(".toml") else named
    name = out.resolve().name
    files = scenario_for(recording, vehicle, name, described)
    check_folder(out, force=force, ours=frozenset(files), writer=_WRITER)
    for file, text in files.items():
        with writing(out / file, "name another folder with --out"):
            (out / file).write_text(text, encoding="utf-8", newline="\n")
    others = int((~parked(recording.vehicles)).sum()) - 1
    if others:
        console.print(f"{others} other vehicle(s) that drive in '{recording.name}' are left out")
    print_place(console, "Scenario", out)
    console.print(f"Run it: giveway run {escape(str(out))}/ --out RESULTS", highlight=False)
    if recording.dataset.citation:
        console.print(f"Please cite: {escape(recording.dataset.citation)}", highlight=False)


def compare_command(
    runs: Sequence[Path], out: Path | None, *, force: bool, quiet: bool, unsealed: bool = False
) -> None:
    """Print one table of the runs and of the recorded drivers in whose place they drove.

    Raises:
        GivewayError: one line that says what to do.
    """
    console = Console(quiet=quiet)
    if out is not None:
        check_folder(out, force=force, ours=frozenset({_TABLE}), writer=_WRITER)
    found = compared(runs, unsealed=unsealed)
    console.print(_comparison(found))
    if out is not None:
        with writing(out / _TABLE, "name another folder with --out"):
            found.round(6).to_csv(out / _TABLE, index=False, lineterminator="\n")
        print_place(console, "Table", out)


def _comparison(found: pd.DataFrame) -> Table:
    """Return the table with a column for each driver."""
    drives = found.to_dict("records")
    several = len({(row["recording"], row["vehicle"]) for row in drives}) > 1
    heads = [f"{r['driver']} {r['recording']}" if several else str(r["driver"]) for r in drives]
    about = f"{drives[0]['recording']}, vehicle {drives[0]['vehicle']}"
    title = "In place of recorded vehicles" if several else f"In place of {about}"
    caption = "people: outline to outline; first: at places of both; PET: while it drives"
    columns = numbers_of(*(escape(head) for head in heads))
    table = Table(*columns, title=escape(title), caption=caption)
    for name, words in MEASURES:
        table.add_row(escape(words), *(_cell(name, row[name]) for row in drives))
    return table


def _cell(name: str, value: object) -> str:
    number = float(str(value))
    if number != number:  # nan: there was nobody
        return "-"
    if name == "standing":
        return f"{number:.0%}"
    return f"{number:.0f}" if name in _COUNTS else f"{number:.2f}"
