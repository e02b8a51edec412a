"""The files of a comparison in corridors."""

from __future__ import annotations

import numpy as np
import pandas as pd

from giveway.validation.corridors.comparison import InCorridors
from giveway.validation.corridors.output import CORRIDOR_FILES, write_corridors


def test_table_and_diagram_are_written(tmp_path) -> None:
    who = ["recorded"] * 6 + ["simulated"] * 6
    windows = pd.DataFrame({"who": who, "density": 0.7, "speed": [1.0] * 6 + [1.2] * 6})
    flows = pd.DataFrame({"recorded": [2.0], "simulated": [2.1]}, index=["one"])
    write_corridors(InCorridors(1, np.ones(12), windows, flows), "made", tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == CORRIDOR_FILES
    table = pd.read_csv(tmp_path / "corridor.csv")
    assert table["difference"].round(3).tolist() == [0.2, 0.05]
    assert table["within_bar"].tolist() == [False, True]
