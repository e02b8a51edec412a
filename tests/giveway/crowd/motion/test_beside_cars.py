"""People beside a vehicle that passes keep off its sides and its rear."""

import numpy as np
import pytest

from giveway.crowd.motion.beside_cars import keep_off
from pedestrian_model import Vehicles


def moved(place: tuple, velocity: tuple = (0.0, 0.0), speed: float = 5.0, turn: float = 0.0):
    """Where a person is moved beside a car of 4 m by 2 m, front at (0, 0), and the velocity."""
    cos, sin = np.cos(turn), np.sin(turn)
    round_ = np.array([[cos, sin], [-sin, cos]])
    places, velocities = np.array([place]) @ round_, np.array([velocity]) @ round_
    cars = Vehicles.create(0.0, 0.0, turn, speed, front=0.0, rear=4.0, width=2.0)
    keep_off(places, velocities, cars, 0.27, 0.1)
    return (places @ round_.T)[0], (velocities @ round_.T)[0]


@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_they_are_moved_away_and_walk_no_nearer(turn: float) -> None:
    place, velocity = moved((-2.0, 1.3), (1.0, -1.0), turn=turn)
    assert place == pytest.approx((-2.0, 1.4))
    assert velocity == pytest.approx((1.0, 0.0))
    place, velocity = moved((-2.0, -1.65), (0.0, -1.0), turn=turn)  # by 2 cm only, and goes on
    assert place == pytest.approx((-2.0, -1.67))
    assert velocity == pytest.approx((0.0, -1.0))
    place, velocity = moved((-4.3, 1.4), (0.6, -0.8), turn=turn)  # at the rear's corner
    assert place == pytest.approx((-4.36, 1.48))
    assert velocity == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize(
    ("place", "speed"),
    [((0.1, 1.2), 5.0), ((-2.0, 0.5), 5.0), ((-2.0, 1.7), 5.0), ((-2.0, 1.2), 0.4)],
    ids=["before the front", "in the body", "far", "beside a car that stands"],
)
def test_others_stay(place: tuple, speed: float) -> None:
    assert moved(place, (0.0, -1.0), speed)[0].tolist() == list(place)
    assert moved(place, (0.0, -1.0), speed)[1].tolist() == [0.0, -1.0]
