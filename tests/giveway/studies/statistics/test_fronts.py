"""Fronts: which controllers nobody beats on both sides."""

from __future__ import annotations

import numpy as np

from giveway.studies.statistics.fronts import on_front


def test_the_front_is_who_nobody_beats_on_both_sides():
    x, y = np.array([1.0, 2.0, 3.0, 2.0, 1.0]), np.array([5.0, 3.0, 4.0, 3.0, 6.0])
    assert on_front(x, y).tolist() == [True, True, False, True, False]
