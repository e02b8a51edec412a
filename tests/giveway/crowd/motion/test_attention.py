"""Distracted pedestrians: they react to a vehicle only when it is near."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.crowd.motion.attention import Inattentive, distance_to_next
from pedestrian_model import PLAIN_MODELS, SIM, Crowd, CrowdModel, PlainModel, Vehicles

STEP = 0.05


CAR = Vehicles.create(0.0, 0.0, 0.0, 2.0, front=2.5, rear=2.5, width=2.0)


def before_a_car() -> Crowd:
    """Two who walk towards the way of a car that comes: 3 m and 1 m from its front and side."""
    return Crowd.create(
        [(5.5, -1.0), (1.0, -2.0)], [(0.0, 1.3)] * 2, 1.3, [[(5.5, 20.0)], [(1.0, 20.0)]]
    )


def models() -> list:
    return [CrowdModel(SIM, STEP), *(PlainModel(name, SIM, STEP) for name in PLAIN_MODELS)]


@pytest.mark.parametrize("model", models(), ids=["vci", *PLAIN_MODELS])
def test_who_is_distracted_feels_no_vehicle_until_it_is_near(model) -> None:
    feeling, alone, distracted = before_a_car(), before_a_car(), before_a_car()
    model.advance(feeling, CAR)
    model.advance(alone, Vehicles.empty())
    Inattentive(model, lambda: np.array([True, True])).advance(distracted, CAR)
    assert np.array_equal(distracted.velocity[0], alone.velocity[0])
    assert np.array_equal(distracted.position[0], alone.position[0])
    assert np.array_equal(distracted.velocity[1], feeling.velocity[1])  # 1 m from it
    if model.__class__ is CrowdModel:
        assert not np.array_equal(feeling.velocity[0], alone.velocity[0])  # and it would matter


def test_without_distracted_people_the_model_is_unchanged() -> None:
    model = CrowdModel(SIM, STEP)
    plain, wrapped = before_a_car(), before_a_car()
    model.advance(plain, CAR)
    Inattentive(model, lambda: np.array([False, False])).advance(wrapped, CAR)
    assert plain.velocity.tobytes() == wrapped.velocity.tobytes()


def test_distances_are_those_to_the_rectangle() -> None:
    turned = Vehicles.create(10.0, 0.0, np.pi / 2, 0.0, front=2.0, rear=3.0, width=2.0)
    points = np.array([[10.0, 5.0], [10.0, -4.0], [12.5, 0.0], [13.0, 4.0], [10.0, 0.0]])
    told = distance_to_next(points, turned)
    assert told == pytest.approx([3.0, 1.0, 1.5, np.hypot(2.0, 2.0), 0.0])
