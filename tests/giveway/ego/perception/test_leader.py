"""What an ego expects of the vehicles beside its path."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.ego.perception.leader import vehicles_in_front
from giveway.geometry.path import EgoPath

DT = 0.05  # [s]
N = 60
BEND = np.pi / 2 * np.linspace(0.0, 1.0, 46)
#: 40 m straight, then a bend of 30 m radius to the left.
PATH = EgoPath.through(
    np.concatenate(
        [
            [(-40.0, 0.0)],
            np.column_stack([30.0 * np.sin(BEND), 30.0 * (1.0 - np.cos(BEND))]),
        ]
    )
)


def expected(
    x: float,
    y: float,
    heading: float,
    speed: float,
    straight: int,
    *,
    path: EgoPath = PATH,
    beside: bool = False,
) -> float:
    """How near [m] a vehicle is expected in front of an ego that is at the bend's begin."""
    steps = DT * speed * np.arange(N)
    poses = np.zeros((N, 2, 7))
    poses[:, 0, 0] = -40.0  # the ego's row
    poses[:, 1, 0], poses[:, 1, 1] = x + steps * np.cos(heading), y + steps * np.sin(heading)
    poses[:, 1, 2:] = heading, speed, 2.5, 2.5, 1.8
    ahead = np.empty(N)
    front, half_width = 40.0, 1.4
    road, known = (path.vertices, path.stations, path.headings), np.array([beside])
    motion = (front, 4.0 * DT, DT)
    vehicles_in_front(road, poses, 0, motion, (half_width, straight), known, ahead)
    return float(ahead.min() - front)


def test_who_overtakes_in_a_bend_is_expected_to_keep_to_its_lane():
    """A faster car on the lane to the right, which straight on would cross the ego's."""
    overtaking = (1.0, -3.2, 0.05, 13.0)
    inside = (-6.0, 3.2, 0.0, 13.0)  # on the lane to the left: straight on, it would cut in
    assert expected(*inside, straight=N) < 15.0
    assert expected(*inside, straight=20) == np.inf
    assert expected(*overtaking, straight=20) == np.inf


@pytest.mark.parametrize("heading", [np.pi / 2, -np.pi / 2, np.pi / 4])
def test_who_comes_from_the_side_is_still_expected(heading):
    x, y = 8.0 - 6.0 * np.cos(heading), 1.0 - 6.0 * np.sin(heading)
    assert expected(x, y, heading, 8.0, straight=20) < 12.0


@pytest.mark.parametrize("heading", [np.pi / 2, -np.pi / 2])
def test_whose_lane_leads_past_the_path_is_not_expected_on_it(heading):
    """But where it is in front now, it is."""
    x, y = 8.0 - 6.0 * np.cos(heading), 1.0 - 6.0 * np.sin(heading)
    assert expected(x, y, heading, 8.0, straight=20, beside=True) == np.inf
    there = 8.0, 1.0, heading, 8.0
    assert expected(*there, straight=20, beside=True) < 12.0


def test_who_crosses_beyond_the_end_of_the_path_is_no_matter():
    """There the ego is at its goal."""
    crossing = 8.0, -7.0, np.pi / 2, 8.0
    ends = EgoPath.through([(-40.0, 0.0), (5.0, 0.0)])
    goes_on = EgoPath.through([(-40.0, 0.0), (15.0, 0.0)])
    assert expected(*crossing, straight=20, path=ends) == np.inf
    assert expected(*crossing, straight=20, path=goes_on) < 8.0
