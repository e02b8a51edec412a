"""Standing: one uninterrupted stop is one waiting time."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.metrics import (
    waiting_times,
)


@pytest.mark.parametrize(
    ("case", "speed", "expected"),
    [
        ("never stands", [4, 3, 2, 1, 0.2, 1], []),
        ("stands once", [4, 0.1, 0.0, 0.19, 1, 2], [1.5]),
        ("stands twice", [0.0, 1, 0.0, 0.0, 1, 2], [0.5, 1.0]),
        ("stands to the end", [4, 3, 2, 0.0, 0.0, 0.0], [1.0]),
        ("stands all the time", [0.0] * 6, [2.5]),
    ],
)
def test_one_uninterrupted_stop_is_one_waiting_time(ego, case, speed, expected):
    track = ego(0.5 * np.arange(6), speed=np.array(speed, dtype=float))
    assert waiting_times(track) == pytest.approx(expected), case
