"""The fundamental diagram."""

from __future__ import annotations

import pandas as pd

from giveway.figures.fundamental_diagram import fundamental_diagram


def test_recorded_and_simulated_points_and_means_are_drawn() -> None:
    who = ["recorded"] * 3 + ["simulated"] * 2
    points = pd.DataFrame({"who": who, "density": [0.2, 0.6, 0.8, 0.3, 0.7], "speed": 1.2})
    means = pd.DataFrame({"recorded": [1.3, 1.1], "simulated": [1.2, 1.0]}, index=[0, 1])
    (axes,) = fundamental_diagram(points, means, 0.5, "made").axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["recorded", "simulated"]
    assert axes.lines[1].get_xydata().tolist() == [[0.25, 1.2], [0.75, 1.0]]
    assert [len(each.get_offsets()) for each in axes.collections] == [3, 2]
    assert axes.get_ylim()[0] == 0.0
