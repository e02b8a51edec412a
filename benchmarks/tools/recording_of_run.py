"""Writes a run as a recording, in the layout of CITR and DUT: people and the first ego.

Run: python benchmarks/tools/recording_of_run.py RUN_FOLDER NAME --out FOLDER [--every 2]

The bundled recording, ``sumo_scenarios/recorded/yard_traj_*_filtered.csv``, was made so, with the
rows up to 15 s after the ego's departure:

    giveway run encounter --controller mpc --pedestrians 10 --seed 4 --record-near 500 \
        --vehicle-length 4.5 --vehicle-width 1.8 --time-limit 15 --out run
    python benchmarks/tools/recording_of_run.py run yard --out sumo_scenarios/recorded
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from giveway.replays.run_folder import RunFolder
from giveway.results.recorded_drive import recording_of_run

if TYPE_CHECKING:
    from giveway.recordings import Recording, Tracks

PEOPLE = "id,frame,label,x_est,y_est,vx_est,vy_est"
VEHICLES = "id,frame,label,x_est,y_est,psi_est,vel_est"


def lines_of(recording: Recording, every: int) -> tuple[list[str], list[str]]:
    """Return the lines of the people's and of the vehicles' file.

    Args:
        recording: Recording of a run.
        every: Number of instants of the run from one frame to the next.
    """
    people, cars = recording.people, recording.vehicles
    walked = _lines(people, every, "ped", people.position, people.velocity)
    front, rear, _ = cars.body.T
    ahead = ((front - rear) / 2.0)[cars.track, None]
    middle = cars.position + ahead * np.column_stack([np.cos(cars.heading), np.sin(cars.heading)])
    motion = np.column_stack([cars.heading, cars.speed])
    return [PEOPLE, *walked], [VEHICLES, *_lines(cars, every, "veh", middle, motion)]


def _lines(
    tracks: Tracks, every: int, label: str, places: np.ndarray, motion: np.ndarray
) -> list[str]:
    kept = np.flatnonzero(tracks.frame % every == 0).tolist()
    return [
        f"{tracks.track[row] + 1},{tracks.frame[row] // every},{label},"
        + ",".join(f"{value + 0.0:.3f}" for value in (*places[row], *motion[row]))
        for row in kept
    ]


def main() -> None:
    """Write the two files."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("name", metavar="NAME")
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--every", type=int, default=2, help="instants per frame (default: 2)")
    options = parser.parse_args()
    recording = recording_of_run(RunFolder.read(options.run))
    for kind, lines in zip(("ped", "veh"), lines_of(recording, options.every), strict=True):
        file = options.out / f"{options.name}_traj_{kind}_filtered.csv"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
        print(file)


if __name__ == "__main__":
    main()
