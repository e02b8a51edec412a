"""The kept numbers of the rivals: controllers of giveway, and drivers who were recorded."""

from importlib.resources import files

import pandas as pd

from giveway.studies.benchmark.definition import VERSION

RECORDED = "recorded drivers"
"""Name of the row of the recorded drivers, in place of a controller."""

# Drivers of the nine roundabout clips of DUT (Yang et al. 2019) that docs/recordings.md measures by
# giveway data measure: people passed closely and tightly, with intervals over vehicles
_DUT = {
    "benchmark": VERSION,
    "made_with": "docs/recordings.md",
    "controller": RECORDED,
    "people": "recorded",
    "scene": "DUT, 9 clips",
    "drives": 16,
    "people_near": 155,
    "close_pass_share": 0.039,
    "close_pass_share_low": 0.0,
    "close_pass_share_high": 0.091,
    "close_pass_share_moving": 0.039,
    "close_pass_share_moving_low": 0.0,
    "close_pass_share_moving_high": 0.091,
    "close_passes": 6 / 16,
    "tight_passes": 3 / 16,
}


def rivals() -> pd.DataFrame:
    """Return the kept rows of the rivals, in the columns of the table, recorded drivers last.

    The evidence of the repository makes them anew by the same command (docs/benchmark.md).
    """
    with (files("giveway.studies.benchmark") / "rivals.csv").open(encoding="utf-8") as file:
        kept = pd.read_csv(file, keep_default_na=False, na_values=[""])
    return pd.concat([kept, pd.DataFrame([_DUT])], ignore_index=True)[list(kept.columns)]
