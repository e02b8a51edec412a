"""The child from behind parked cars (CPNCO) for cars with weaker and weaker brakes, as a picture.

Run: python benchmarks/ncap/brakes.py --out FOLDER [--jobs 2]

The car is giveway's own, 1000 kg and 1.8 m wide; its largest force is 8 to 3 kN. FOLDER gets
``brakes.csv``, the rows of ``giveway ncap --only CPNCO`` for each of them, and ``brakes.png``. The
tables themselves are folders there, from which each cell can be made again.
"""

import argparse
from pathlib import Path

import matplotlib as mpl
import pandas as pd

from giveway.ncap.request import NcapRequest, requested_ncap
from giveway.ncap.table import outcomes_of, tables_of, write_ncap
from giveway.studies.study import run_study
from giveway.studies.study_options import StudyOptions

mpl.use("Agg")
from matplotlib import pyplot as plt

FORCES = (8000, 5000, 4000, 3000)  # N
KEPT = ["force", "hit_point", "speed", "relative_speed", "colour", "first_sight_distance"]
PAINT = {
    "green": "#3fa34d",
    "yellow": "#ffe34d",
    "orange": "#f5a13b",
    "brown": "#a5713d",
    "red": "#c2262e",
}


def main() -> None:
    """Make the tables, and draw them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    rows = pd.concat([table(force, options.out, options.jobs) for force in FORCES])[KEPT]
    rows.to_csv(options.out / "brakes.csv", index=False, lineterminator="\n")
    print(rows.pivot(index="speed", columns=["force", "hit_point"], values="relative_speed"))
    draw(rows, options.out / "brakes.png")


def table(force: int, out: Path, jobs: int) -> pd.DataFrame:
    """Return the cells of CPNCO for the largest force [N] of the car."""
    out.mkdir(parents=True, exist_ok=True)
    config = out / f"car{force}.toml"
    config.write_text(f"[vehicle]\nforce_limit = {force}.0\nwidth = 1.8\n")
    folder = out / f"force{force}"
    request = NcapRequest(
        "fmi2", None, "euroncap", "2026", None, config, tests=["CPNCO"], out=folder
    )
    asked = requested_ncap(request)
    resume = (folder / "manifest.json").exists()
    study = run_study(asked.definition, "brakes.py", folder, StudyOptions(jobs=jobs, resume=resume))
    outcomes = outcomes_of(study, asked.protocol, asked.runs, asked.width)
    frame = write_ncap(folder, tables_of(asked.protocol, outcomes))
    return frame[frame["test"] == "CPNCO"].assign(force=force)


def draw(rows: pd.DataFrame, file: Path) -> None:
    """Draw a matrix for each force: hit points over speeds, coloured."""
    hits, speeds = sorted(rows["hit_point"].unique()), sorted(rows["speed"].unique())
    figure, panels = plt.subplots(
        1, len(FORCES), figsize=(10.0, 2.1), sharey=True, layout="constrained"
    )
    for axes, (force, mine) in zip(panels, rows.groupby("force", sort=False), strict=True):
        for row in mine.itertuples():
            x, y = speeds.index(row.speed), hits.index(row.hit_point)
            axes.add_patch(plt.Rectangle((x - 0.48, y - 0.46), 0.96, 0.92, color=PAINT[row.colour]))
            dark = row.colour in {"brown", "red"}
            text = f"{row.relative_speed:.0f}\n{row.colour[0].upper()}"
            axes.text(x, y, text, ha="center", va="center", fontsize=8, color="w" if dark else "k")
        axes.set(xlim=(-0.6, len(speeds) - 0.4), ylim=(len(hits) - 0.4, -0.6))
        axes.set_xticks(range(len(speeds)), speeds)
        axes.set_yticks(range(len(hits)), [f"{hit} %" for hit in hits])
        axes.set_title(f"{force / 1000:g} m/s²", fontsize=10)
        axes.set_xlabel("speed [km/h]")
        axes.spines[:].set_visible(False)
        axes.tick_params(length=0)
    figure.savefig(file, dpi=130)
    plt.close(figure)


if __name__ == "__main__":
    main()
