"""Lets controllers drive in place of each recorded vehicle, and prints all their drives' sums.

Run: python benchmarks/tools/in_place_of_recorded.py FOLDER --dataset dut --out runs
         [--controllers mpc,pid-tuned,careful-driver] [--set KEY=VALUE ...]

Each drive is a scenario of ``giveway data scenario`` and a run of it, in folders of their own below
``--out``. The sums of all recorded drivers, and of each controller, are those of ``giveway data
compare``. With ``--set crowd.model=vci``, people are simulated from their entry on.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import pandas as pd

import giveway
from giveway.recordings import dataset_of, read_recordings
from giveway.recordings.describing import parked
from giveway.recordings.measuring import measure
from giveway.recordings.replacing import scenario_for
from giveway.results.recorded_drive import RECORDED_DRIVER, compared

sys.path.append(str(Path(__file__).resolve().parents[1] / "bounds"))

from markdown_table import markdown

SUMS = ("near", "close", "short_ttc", "short_pet", "person_first", "vehicle_first", "touched")
TITLES = {
    "time": "time [s]",
    "near": "people within 4 m",
    "close": "passed at less than 0.5 m and more than 2 m/s",
    "short_ttc": "TTC below 1.5 s",
    "short_pet": "PET below 1 s",
    "person_first": "person first",
    "vehicle_first": "vehicle first",
}
CONTROLLERS = "mpc,pid-tuned,careful-driver"


def drives(folder: Path, dataset: str, out: Path) -> list[Path]:
    """Write a scenario for each vehicle that drives, and return their folders.

    Args:
        folder: Folder of the recordings.
        dataset: Name of the data set, or path of its description.
        out: Folder for the scenarios.
    """
    written = []
    for recording in read_recordings(folder, dataset_of(dataset)):
        some = bool((~parked(recording.vehicles)).any())
        known = measure([recording]).drives["vehicle"].tolist() if some else []
        for vehicle in known:
            name = f"{recording.name}-{vehicle}"
            place = out / name
            place.mkdir(parents=True, exist_ok=True)
            for file, text in scenario_for(recording.walkers(), vehicle, name, dataset).items():
                (place / file).write_text(text, encoding="utf-8")
            written.append(place)
    return written


def sums(table: pd.DataFrame) -> pd.Series[float]:
    """Return the number of drives, their time [s] and the numbers of people of a table's rows."""
    whole = table[list(SUMS)].sum()
    return pd.concat([pd.Series({"drives": len(table), "time": table["duration"].sum()}), whole])


def main() -> None:
    """Drive, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--dataset", required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--controllers", default=CONTROLLERS)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    settings = dict(pair.split("=", 1) for pair in options.set)
    scenarios = drives(options.folder, options.dataset, options.out / "scenarios")
    rows = {}
    for controller in options.controllers.split(","):
        folders = []
        for place in scenarios:
            folders.append(options.out / controller / place.name)
            giveway.run(
                {"scenario": str(place), "controller": controller, **settings},
                results=folders[-1],
                force=True,
                pictures=False,
            )
        table = compared(folders)
        recorded = table["driver"] == RECORDED_DRIVER
        rows.setdefault(RECORDED_DRIVER, sums(table[recorded]))
        rows[controller] = sums(table[~recorded])
    table = pd.DataFrame(rows).T.rename_axis("driver").reset_index()
    counts = [name for name in table.columns if name not in {"driver", "time"}]
    print(markdown(table.astype(dict.fromkeys(counts, int)).rename(columns=TITLES)))


if __name__ == "__main__":
    main()
