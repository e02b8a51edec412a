"""Who has walked away behind something counts as not seen, and stops nobody any more."""

import numpy as np

from giveway.config import EgoRunConfig
from giveway.ego.perception.protocol import OwnState
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.truth import Truth
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

OWN = OwnState(Pose(0.0, 0.0, 0.0), 0.0, 0, VehicleShape(4.5, 1.8))
EGO = -2.25, 0.0, 0.0, 5.0, 2.25, 2.25, 1.8
PARKED = 8.0, -2.9, 0.0, 0.0, 2.25, 2.25, 1.8  # right of the way, its front at x = 10.25 m


def remembered(velocity: float, *, behind: bool = True, **config: object) -> int:
    """For how many steps a child is still perceived who was last seen at y = -1.7 m.

    Args:
        velocity: Velocity [m/s] of the child to the left of the ego's way.
        behind: Whether the child is behind the parked car from then on; else it is missed.
        config: Further settings of the ego.
    """
    sees = {"perception": {"sensor": "sight", "tracker": False}}
    perception, steps = Perception(EgoRunConfig(**sees | config), 3.0, 0.05), 0
    people = Crowd.create([[11.0, -1.7]], [[0.0, velocity]], 1.3, [[[11.0, 9.0]]])
    ids, tops = np.array([0]), (np.full(2, 1.5), np.full(1, 1.15))
    cars, no_walls = np.array([EGO, PARKED]), np.empty((0, 5))
    seen = perception.observe(Truth(people, cars, no_walls, 0.0, *tops), ids, OWN)
    assert len(seen.people) == 1
    people.position[:] = (11.0, -3.5) if behind else (300.0, 0.0)
    for step in range(1, 41):
        truth = Truth(people, cars, no_walls, 0.05 * step, *tops)
        steps += len(perception.observe(truth, ids, OWN).people)
    return steps


def test_who_has_walked_away_behind_something_counts_as_not_seen():
    """The child is expected farther to the right by 0.14 m per step, and soon behind the car."""
    assert 1 <= remembered(-2.8) <= 5
    assert remembered(-2.8, safety={"hidden_speed": 0.0}) == 20  # nobody is expected to come out


def test_who_is_lost_on_the_way_to_the_path_or_in_the_open_is_remembered():
    assert remembered(0.5) == 20
    assert remembered(0.0) == 20
    assert remembered(0.5, behind=False) == 20
