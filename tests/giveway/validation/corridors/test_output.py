"""The files of a comparison in corridors."""

from __future__ import annotations

import numpy as np
import pandas as pd

from giveway.validation.corridors.comparison import Comparison, Walked
from giveway.validation.corridors.output import FILES, write_corridors


def test_tables_and_diagram_are_written(tmp_path) -> None:
    recorded = Walked(np.full(6, 0.7), np.full(6, 1.0), np.array([2.0]))
    simulated = Walked(np.full(6, 0.6), np.full(6, 1.2), np.array([2.1]))
    found = Comparison(("one",), 0, 12, np.array([1.3]), recorded, simulated)
    write_corridors(found, "made", tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == FILES
    table = pd.read_csv(tmp_path / "corridor.csv")
    assert table["difference"].round(3).tolist() == [0.2, 0.05]
    assert table["within_bar"].tolist() == [False, True]
    assert len(pd.read_csv(tmp_path / "points.csv")) == 12
