"""Somebody else's model: what it is told, what its answers mean, and what limits them."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.plug_ins.plugged_in_model import PluggedInModel
from pedestrian_model import (
    SIM,
    Accelerations,
    Crowd,
    CrowdModel,
    ModelSetup,
    PlugInError,
    Surroundings,
    Vehicles,
    Velocities,
    Walls,
)

H = 0.05
SETUP = ModelSetup(H, SIM.body_radius, SIM.max_acceleration, SIM.max_speed, 1)
NO_CAR = Vehicles.empty()


class Answers:
    def __init__(self, answer: object) -> None:
        self.answer, self.seen = answer, []

    def step(self, walkers):
        self.seen.append(walkers)
        return self.answer(walkers) if callable(self.answer) else self.answer


def hosted(answer: object) -> tuple[PluggedInModel, Answers]:
    plug_in = Answers(answer)
    return PluggedInModel("'a:B'", lambda: plug_in, SETUP, SIM), plug_in


def two() -> Crowd:
    return Crowd.create(
        [[0.0, 0.0], [4.0, 1.0]], [[1.0, 0.0], [0.0, 0.0]], 1.2, [[[9.0, 0.0]], [[4.0, 1.1]]]
    )


@pytest.mark.parametrize(
    ("answer", "velocity"),
    [
        (np.full((2, 2), 2.0), [[1.1, 0.1], [0.1, 0.1]]),
        (Accelerations(np.full((2, 2), 2.0)), [[1.1, 0.1], [0.1, 0.1]]),
        (Accelerations([[0, 1], [1, 0]]), [[1.0, 0.05], [0.05, 0.0]]),
        (Velocities(np.array([[1.2, 0.0], [0.0, -0.1]])), [[1.2, 0.0], [0.0, -0.1]]),
        (Velocities(np.array([[9.0, 0.0], [0.0, 9.0]])), [[1.25, 0.0], [0.0, 0.25]]),
        (Accelerations(np.array([[-1e9, 0.0], [30.0, 40.0]])), [[0.75, 0.0], [0.15, 0.2]]),
    ],
)
def test_an_answer_becomes_a_motion_within_the_limits(answer, velocity):
    crowd = two()
    before, v = crowd.position.copy(), crowd.velocity.copy()
    hosted(answer)[0].advance(crowd, NO_CAR)
    assert crowd.velocity == pytest.approx(np.array(velocity))
    assert crowd.position == pytest.approx(before + 0.5 * H * (v + velocity))


def test_nobody_gets_faster_than_people_are():
    crowd = two()
    model, _ = hosted(np.full((2, 2), 1e6))
    for _ in range(100):
        model.advance(crowd, NO_CAR)
        assert np.hypot(*crowd.velocity.T).max() <= SIM.max_speed * (1.0 + 1e-12)


def test_what_it_is_told():
    walls = Surroundings(Walls.create([[0.0, -1.0, 8.0, -1.0]]))
    model, plug_in = hosted(np.zeros((2, 2)))
    crowd = two()
    car = Vehicles.create([2.0], [-3.0], [0.0], [4.0])
    model.advance(crowd, car, walls)
    (seen,) = plug_in.seen
    assert seen.goals.position.tolist() == [[9.0, 0.0], [4.0, 1.1]]
    assert seen.goals.stops.tolist() == [True, True]
    assert seen.preferred[0] == pytest.approx([1.2, 0.0], abs=1e-3)
    assert 0.3 < seen.preferred[1, 1] < 0.5  # 0.1 m before the end of the way
    assert seen.walls.distance == pytest.approx([1.0, 2.0])
    assert seen.walls.normal == pytest.approx(np.array([[0.0, 1.0], [0.0, 1.0]]))
    assert seen.vehicles.tolist() == car.array.tolist()
    told = [array for field in seen for array in (field if isinstance(field, tuple) else (field,))]
    assert all(not array.flags.writeable for array in told)


def test_way_points_and_red_lights_are_ours():
    route = [[2.0, 0.0], [5.0, 0.0]]
    crowd = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.0, [route], signals=[[0, -1]])
    closed = np.array([True])
    around = Surroundings(closed=closed)
    model, plug_in = hosted(lambda walkers: 2.0 * (walkers.preferred - walkers.velocity))
    for _ in range(200):
        model.advance(crowd, NO_CAR, around)
    assert crowd.position[0] == pytest.approx([2.0, 0.0], abs=0.2)
    assert plug_in.seen[-1].goals.stops.all()
    closed[0] = False
    model.advance(crowd, NO_CAR, around)
    assert plug_in.seen[-1].goals.position.tolist() == [[5.0, 0.0]]
    vci = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.0, [route], signals=[[0, -1]])
    CrowdModel(SIM, H).advance(vci, NO_CAR, around)
    assert vci.waypoint_index.tolist() == [0]


def test_bad_answers_name_the_person_they_are_about():
    bad = np.zeros((2, 2))
    bad[1] = np.inf
    with pytest.raises(PlugInError, match=r"returned .*inf.*: expected finite") as caught:
        hosted(bad)[0].advance(two(), NO_CAR)
    assert caught.value.person == 1
    for wrong in (None, "away", np.zeros(2), np.zeros((3, 2)), Velocities(np.zeros((2, 3)))):
        with pytest.raises(PlugInError, match=r"expected Accelerations or Velocities of \(2, 2\)"):
            hosted(wrong)[0].advance(two(), NO_CAR)


def test_nobody_is_asked_of_nobody():
    model, plug_in = hosted(None)
    model.advance(Crowd.empty(), NO_CAR)
    assert plug_in.seen == []
