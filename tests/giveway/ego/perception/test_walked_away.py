"""Who has walked away behind something counts as not seen, and stops nobody any more."""

import numpy as np

from controller import Decision, SafetyParameters
from giveway.config import EgoRunConfig
from giveway.ego.perception.hidden_people import HidingPlaces
from giveway.ego.perception.protocol import OwnState
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.truth import Truth
from giveway.ego.perception.visibility import CHILD, RADIUS
from giveway.ego.safety_layer import RUSHES, EgoSafetyLayer
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath, Pose
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


CARS = [(x, -2.8, 0.0, 0.0, 2.25, 2.25, 1.8) for x in (18.0, 23.5, 30.0)]  # a gap at 26.75 m
PATH, STEP = EgoPath.through([(0.0, 0.0), (100.0, 0.0)]), 0.05
SHAPE, HALF = VehicleShape(4.5, 1.8), 0.9  # m
CROSSES, COMES_OUT, GAINS = -1.4, 0.3, 0.6  # m/s, m/s, m/s^2


class ChildTurnsRound:
    """A drive by a controller that never brakes, past a child that crosses, hides and comes back.

    It comes out of hiding at 0.3 m/s and accelerates by 0.6 m/s^2 once in sight: as is assumed.
    """

    def __init__(self) -> None:
        self.config = EgoRunConfig(
            controller="mpc", perception={"sensor": "sight", "tracker": False}
        )
        self.left_out = 0

    def impact(self, x: float, start: float, depth: float, wait: float) -> float:
        """Return the speed [m/s] at which the front hits the child, or 0.

        Args:
            x: Station [m] of the child.
            start: Place [m] on the left at which it begins to cross.
            depth: Place [m] on the right at which it turns round.
            wait: Time [s] for which it stays there.
        """
        layer = EgoSafetyLayer(SafetyParameters(force_limit=8000.0), self.config, PATH, SHAPE, STEP)
        perception, places = Perception(self.config, 3.0, STEP), HidingPlaces(PATH, COMES_OUT)
        vehicle, front, speed, y, v = self.config.vehicle, 8.0, 4.0, start, CROSSES
        for step in range(200):
            child = Crowd.create([[x, y]], [[0.0, v]], 1.4, [[[x, y + 20.0 * v]]])
            ego = front - 0.5 * SHAPE.length, 0.0, 0.0, speed, 2.25, 2.25, SHAPE.width
            tops = np.full(1 + len(CARS), 1.5), np.full(1, CHILD)
            world = Truth(child, np.array([ego, *CARS]), np.empty((0, 5)), STEP * step, *tops)
            here = OwnState(Pose(front, 0.0, 0.0), speed, 0, SHAPE)
            percept = perception.observe(world, np.zeros(1, np.int64), here)
            self.left_out += v >= 0.0 and not len(percept.people)
            if x - front > 0.0 and np.hypot(x - front, max(0.0, abs(y) - HALF)) < RADIUS:
                return speed
            if front > x:
                return 0.0
            asked = Decision(3000.0, "never brakes", "", "", 0, 8.0, None)
            hidden = places.ahead(perception.tells_unseen, world, 0, front, speed)
            force = (layer.overrule(asked, front, speed, percept, hidden=hidden) or asked).force
            after = max(0.0, speed + STEP * (force - vehicle.friction * speed) / vehicle.mass)
            front, speed = front + 0.5 * STEP * (speed + after), after
            if v < 0.0 and y <= depth:
                v = 0.0
            elif v >= 0.0 and wait > 0.0:
                wait -= STEP
            elif v >= 0.0:
                seen = not perception.tells_unseen.unseen(np.array([[x, y]]))[0]
                v = v + GAINS * STEP if seen and v else COMES_OUT
            y += STEP * v
        return 0.0


def test_a_child_that_comes_back_within_the_assumption_is_not_hit_above_walking_pace() -> None:
    random, drive = np.random.default_rng(3), ChildTurnsRound()
    low, high = (25.8, -1.5, -2.8, 0.0), (26.2, 0.5, -2.0, 2.5)
    impacts = [drive.impact(*random.uniform(low, high)) for _ in range(12)]
    assert drive.left_out > 100  # the child was hidden, and not remembered
    assert max(impacts) <= RUSHES
