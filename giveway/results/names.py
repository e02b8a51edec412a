"""The names of the files in a results folder."""

from giveway.run_data.scene import SCENE_FILE

SUMO_FOLDER = "sumo"
MARKS = ("", *(f"_{number}" for number in range(2, 100)))
"""Suffixes of the names of pictures: of the first ego, the second one and so on."""
LONGEST = "trajectories"
"""The longest table, which has other forms than CSV, too."""
TABLES = (
    "ego",
    "trajectories",
    "pedestrians",
    "summary",
    "timing",
    "predictions",
    "ledger",
    "people",
    "signals",
    "sights",
    "signal_delays",
    "waiting",
    "measures",
)
"""All tables that a run can have; its ``schemas`` list the tables that it has."""
FILES = frozenset(
    {
        *(f"{name}{suffix}" for name in TABLES for suffix in (".csv", ".parquet")),
        f"{LONGEST}.csv.gz",
        "config.toml",
        "summary.json",
        "manifest.json",
        "datapackage.json",
        SCENE_FILE,
        "replay.html",
        "density.png",
        "sumo.log",
        *(f"{name}{mark}.png" for name in ("state", "top_view") for mark in MARKS),
        SUMO_FOLDER,
    }
)
"""Everything that giveway writes into a results folder."""
