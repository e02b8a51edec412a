"""The table of docs/risk.md: how likely a frontal contact is per km, for four controllers.

    python benchmarks/risk/contact_per_km.py --out FOLDER --scale 1    # can be ended and resumed
    python benchmarks/risk/contact_per_km.py --out FOLDER --table --keep FILE.csv

Each cell is a folder of ``giveway risk`` with plain Monte Carlo, so that a zero is an upper bound.
A larger ``--scale`` adds runs to the ones that are there.
"""

import argparse
import csv
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from giveway.risk.definition import make_risk
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.session import run_risk
from giveway.risk.tables import per_kilometre
from giveway.studies.study_options import StudyOptions

CONTROLLERS = ("mpc", "pid-tuned", "idm", "careful-driver")


@dataclass(frozen=True)
class Setting:
    """One scenario of the table.

    Attributes:
        name: Name in the table.
        runs: Budget of each of its cells.
        run: Settings of every run.
        inputs: Random inputs of the runs, besides what the seed draws.
    """

    name: str
    runs: int
    run: dict[str, Any]
    inputs: dict[str, Any]


SETTINGS = (
    Setting("shared_space 30", 300, {"scenario": "shared_space", "crowd": {"pedestrians": 30}}, {}),
    Setting("crossings", 50, {"scenario": "crossings"}, {}),
    # the child runs out at a fixed time, and the ego is elsewhere on the road each time
    Setting(
        "parked_cars",
        100,
        {"scenario": "parked_cars"},
        {"ego.depart_position": {"uniform": [0.0, 28.0]}},
    ),
)


@dataclass(frozen=True)
class Cell:
    """One row of the table: the probability of a frontal contact in a run and per km."""

    scenario: str
    controller: str
    layer: str
    runs: int
    events: int
    failed: int
    per_run: float
    distance: float
    per_km: float
    low: float
    high: float


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--scale", type=float, default=1.0, help="factor on all budgets")
    parser.add_argument("--only", action="append", help="name of a scenario in the table")
    parser.add_argument("--jobs", type=int, default=None)
    parser.add_argument("--table", action="store_true", help="make nothing")
    parser.add_argument("--keep", type=Path, help="CSV file for the table, kept beside this one")
    wanted = parser.parse_args()
    settings = [s for s in SETTINGS if not wanted.only or s.name in wanted.only]
    cells = []
    for setting, controller, layer in _cells(settings):
        out = wanted.out / f"{setting.run['scenario']}-{controller}-{'on' if layer else 'off'}"
        if not wanted.table:
            _make(out, setting, controller, layer, wanted.scale, wanted.jobs)
        if (out / "risk.csv").exists():
            cells.append(_cell(out, setting, controller, layer))
    if wanted.keep is not None:
        with wanted.keep.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, [f.name for f in fields(Cell)], lineterminator="\n")
            writer.writeheader()
            writer.writerows(asdict(cell) for cell in cells)
    for line in table(cells):
        print(line)


def _cells(settings: list[Setting]) -> Iterator[tuple[Setting, str, bool]]:
    for setting in settings:
        for controller in CONTROLLERS:
            for layer in (False, True):
                yield setting, controller, layer


def _make(
    out: Path, setting: Setting, controller: str, layer: bool, scale: float, jobs: int | None
) -> None:
    values = {
        "name": out.name,
        "runs": max(1, round(scale * setting.runs)),
        "run": setting.run | {"controller": controller, "safety": {"enabled": layer}},
        "inputs": setting.inputs,
    }
    run_risk(make_risk(values, out.name), out.name, out, StudyOptions(jobs=jobs, resume=True))
    print(f"{out.name}: made", flush=True)


def _cell(out: Path, setting: Setting, controller: str, layer: bool) -> Cell:
    folder = RiskFolder(out)
    estimate = folder.estimate
    kilometre = per_kilometre(folder, estimate)
    return Cell(
        setting.name,
        controller,
        "on" if layer else "off",
        estimate.runs,
        estimate.events,
        estimate.failed,
        estimate.probability,
        kilometre.distance,
        kilometre.rate,
        kilometre.low,
        kilometre.high,
    )


def table(cells: list[Cell]) -> Iterator[str]:
    """Yield the lines of the table in docs/risk.md."""
    yield "| scenario | controller | layer | runs | with a contact | per km | 95 % from | to |"
    yield "|---|---|---|---|---|---|---|---|"
    for cell in cells:
        met = f"{cell.per_km:.2g}" if cell.events else "none met"
        yield (
            f"| {cell.scenario} | {cell.controller} | {cell.layer} | {cell.runs:,} | "
            f"{cell.events:,} | {met} | {cell.low:.2g} | {cell.high:.2g} |"
        )


if __name__ == "__main__":
    main()
