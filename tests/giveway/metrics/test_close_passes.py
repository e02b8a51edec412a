"""Close passes of one vehicle, by hand: clearances at the speeds that it had then."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.metrics import pedestrian_metrics
from giveway.metrics.close_passes import clearances, passes

CAR = VehicleShape(length=5.0, width=2.0)
R = 0.27


def found(rows, people=1):
    """The passes from rows of person, speed [m/s] and clearance [m]."""
    person, speed, clearance = np.array(rows, dtype=float).reshape(-1, 3).T
    return clearances(person.astype(np.int64), speed, clearance, people)


@pytest.mark.parametrize(
    ("speed", "clearance", "near", "moving", "close", "tight", "narrow"),
    [
        (4.0, 4.001, 0, 0, 0, 0, 0),
        (4.0, 4.0, 1, 1, 0, 0, 0),
        (0.5, 0.1, 1, 0, 0, 0, 0),  # not faster than 0.5 m/s
        (0.6, 0.1, 1, 1, 0, 0, 0),
        (1.0, 0.1, 1, 1, 0, 0, 0),
        (1.1, 0.29, 1, 1, 0, 0, 1),
        (2.0, 0.4, 1, 1, 0, 0, 0),
        (2.1, 0.5, 1, 1, 0, 0, 0),
        (2.1, 0.49, 1, 1, 1, 0, 0),
        (3.0, 0.29, 1, 1, 1, 0, 1),
        (3.1, 0.3, 1, 1, 1, 0, 0),
        (3.1, 0.29, 1, 1, 1, 1, 1),
        (3.1, -0.2, 1, 1, 1, 1, 1),  # an overlap
    ],
)
def test_limits_of_speed_and_clearance(speed, clearance, near, moving, close, tight, narrow):
    masks = passes(found([(0, speed, clearance)]))
    assert [int(mask[0]) for mask in masks] == [near, moving, close, tight, narrow]


def test_speed_and_clearance_are_those_of_one_instant():
    """It is fast while it is far, and slow while it is near; who is never seen is nowhere near."""
    apart = found([(0, 4.0, 1.5), (0, 1.5, 0.4), (0, 0.3, 0.1)], people=2)
    assert [values[0] for values in apart] == [0.1, 0.4, 0.4, 1.5, 1.5]
    assert np.isnan(apart).T[1].all()
    assert [mask.tolist() for mask in passes(apart)] == [[True, False]] * 2 + [[False, False]] * 3


def test_a_run_has_the_clearances_of_each_pedestrian(ego, crowd):
    """Its front is at x = 0, 4, 6 and 6.5 m with 4, 2, 0.6 and 0 m/s; the two stand."""
    front = np.column_stack([[0.0, 4.0, 6.0, 6.5], np.zeros(4)])
    track = ego(np.arange(4.0), front, speed=np.array([4.0, 2.0, 0.6, 0.0]))
    ahead, beside = [(7.0, 0.0, 0.0, 0.0)] * 4, [(-1.0, 1.5, 0.0, 0.0)] * 4
    table = pedestrian_metrics(track, crowd((0, ahead), (0, beside)), CAR, R)
    columns = [f"clearance_{name}" for name in ("moving", "above_1", "above_2", "above_3")]
    np.testing.assert_allclose(table.loc[0, columns].astype(float), np.array([1, 3, 7, 7]) - R)
    np.testing.assert_allclose(table.loc[1, columns].astype(float), [0.5 - R] * 4)
    standing = pedestrian_metrics(ego(np.arange(4.0), front), crowd((0, ahead)), CAR, R)
    assert standing[columns].isna().all(axis=None)
