"""The density map: it counts everybody once."""

import numpy as np
import pytest
from support.steady_crowd import STEP, steady_crowd

from giveway.measures import density_map


def test_mean_density_on_a_grid_counts_everybody_once() -> None:
    time = STEP * np.arange(50)
    starts = np.array([(0.1, 0.1), (3.3, 2.2), (5.1, 4.4)])
    found = density_map(steady_crowd(starts, (0.0, 0.0), time), len(time))
    assert found.density.sum() * 0.25 == pytest.approx(3.0)
    row = int((found.top - 2.2) / 0.5)
    column = int((3.3 - found.left) / 0.5)
    assert found.density[row, column] == pytest.approx(4.0)
