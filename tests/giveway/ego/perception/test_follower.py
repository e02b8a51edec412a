"""The vehicle behind the ego."""

import numpy as np
import pytest

from giveway.ego.perception.follower import gap_behind
from giveway.geometry.path import EgoPath

PATH = EgoPath.through([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0)])
WAY = PATH.vertices, PATH.stations, PATH.headings
REAR = 60.0  # station [m] of the ego's rear


def gap(x: float, y: float = 0.0, heading: float = 0.0, rear: float = REAR) -> float:
    """The gap [m] in front of a vehicle of 4 m whose middle is at (x, y)."""
    vehicles = np.zeros((2, 7))
    vehicles[:, 4:6], vehicles[:, 6] = 2.0, 1.8
    vehicles[0, 0] = rear + 2.0
    vehicles[1, :3] = x, y, heading
    return gap_behind(WAY, vehicles, 0, rear, 50.0)


@pytest.mark.parametrize(
    ("x", "y", "heading", "expected"),
    [
        (40.0, 0.0, 0.0, 18.0),
        (10.0, 0.5, 0.1, 48.0),
        (0.0, 0.0, 0.0, np.inf),  # out of sight
        (40.0, 3.2, 0.0, np.inf),  # on the next lane
        (40.0, 0.0, np.pi, np.inf),  # oncoming
        (70.0, 0.0, 0.0, np.inf),  # in front
    ],
)
def test_a_vehicle_behind_on_the_same_lane_counts(
    x: float, y: float, heading: float, expected: float
) -> None:
    assert gap(x, y, heading) == pytest.approx(expected, abs=0.05)


def test_a_vehicle_before_the_bend_is_behind() -> None:
    assert gap(85.0, rear=120.0) == pytest.approx(33.0)


def test_a_vehicle_before_the_begin_of_the_path_is_behind() -> None:
    assert gap(-12.0, rear=5.0) == pytest.approx(15.0)
