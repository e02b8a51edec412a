"""The fundamental diagram."""

from __future__ import annotations

import numpy as np

from giveway.figures.fundamental_diagram import Points, fundamental_diagram


def test_recorded_and_simulated_points_and_means_are_drawn() -> None:
    middles, means = np.array([0.25, 0.75]), np.array([1.3, 1.1])
    people = [
        Points(name, np.array([0.2, 0.6, 0.8]), np.array([1.3, 1.2, 1.0]) * factor, middles, means)
        for name, factor in (("recorded", 1.0), ("simulated", 0.9))
    ]
    (axes,) = fundamental_diagram(people, "made").axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["recorded", "simulated"]
    assert axes.lines[1].get_xydata().tolist() == [[0.25, 1.3], [0.75, 1.1]]
    assert len(axes.collections[0].get_offsets()) == 3
    assert axes.get_ylim()[0] == 0.0
