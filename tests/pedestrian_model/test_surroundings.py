"""Surroundings: signals that are open or closed."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model import (
    Surroundings,
    SurroundingsError,
)


@pytest.mark.parametrize("closed", [[True], np.zeros(2), np.zeros((1, 2), dtype=bool)])
def test_closed_is_an_array_of_bool(closed):
    with pytest.raises(SurroundingsError, match="expected a contiguous array of bool"):
        Surroundings(closed=closed)
