"""False detections of the sensor sight: how many, where, for how long, and under which numbers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.parameters import ParameterError
from giveway.config import EgoRunConfig
from giveway.ego.perception import OwnState, Percept, SensorSetup, Truth
from giveway.ego.perception.conformance import check_sensor
from giveway.ego.perception.false_detections import ids_of, tracks_of
from giveway.ego.perception.plugged_in_sensor import PluggedInSensor
from giveway.ego.perception.sensing import Perception
from giveway.ego.perception.sight import Mount, Sight, SightOptions
from giveway.errors import SensorError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

STEP = 0.05
OWN = OwnState(Pose(0.0, 0.0, 0.0), 8.0, 0, VehicleShape(4.5, 1.8))
BODY = np.array([[-2.25, 0.0, 0.0, 8.0, 2.25, 2.25, 1.8]])
NO_WALLS = np.empty((0, 5))
NOBODY = Crowd.empty()
ALL_ROUND = Mount(range=20.0, field_of_view=360.0)


def sight(*mounts: Mount, seed: int = 1, **options: Any) -> Sight:
    options = {"mounts": mounts or (Mount(),), "memory": 0.0} | options
    return Sight(SensorSetup(STEP, seed, "ego"), SightOptions(**options))


def look(sensor: Sight, step: int, *, own: OwnState = OWN, walls: Any = NO_WALLS) -> Percept:
    truth = Truth(NOBODY, BODY, walls, STEP * step, np.array([1.5]), np.zeros(0))
    return sensor.observe(truth, np.arange(0), own)


def places(sensor: Sight, steps: int, **about: Any) -> dict[int, list[Any]]:
    """Where each false detection was perceived [m], by its id."""
    found: dict[int, list[Any]] = {}
    for step in range(steps):
        percept = look(sensor, step, **about)
        for name, place in zip(percept.person_ids.tolist(), percept.people.position, strict=True):
            found.setdefault(name, []).append(place)
    return found


def test_there_are_none_unless_they_are_asked_for() -> None:
    assert not places(sight(), 200)
    assert not sight().false_detections


def test_each_camera_has_as_many_per_second_as_are_asked_for() -> None:
    cameras = ALL_ROUND, replace(ALL_ROUND, ahead=0.5)
    found = places(sight(*cameras, false_rate=2.0, false_time=0.25), 8000)
    inside = 4.5 * 1.8 / (np.pi * 20.0**2)  # share of the field of view that the ego itself fills
    assert len(found) == pytest.approx(2 * 2.0 * 8000 * STEP * (1.0 - inside), rel=0.05)
    assert {len(there) for name, there in found.items() if name > -len(found) + 20} == {5}


def test_their_places_are_uniform_over_the_field_of_view() -> None:
    camera = Mount(ahead=0.0, range=30.0, field_of_view=90.0)
    found = places(sight(camera, false_rate=5.0), 4000)
    first = np.array([there[0] for there in found.values()])
    far, angle = np.hypot(*first.T), np.degrees(np.arctan2(first[:, 1], first[:, 0]))
    assert far.max() <= 30.0
    assert np.abs(angle).max() <= 45.0
    assert np.median(far) == pytest.approx(30.0 / np.sqrt(2.0), abs=1.0)
    assert np.median(angle) == pytest.approx(0.0, abs=3.0)


def test_none_begins_behind_a_wall_or_in_the_ego() -> None:
    wall = np.array([[5.0, -50.0, 5.0, 50.0, 9.0]])
    first = np.array(
        [there[0] for there in places(sight(ALL_ROUND, false_rate=10.0), 4000, walls=wall).values()]
    )
    assert len(first) > 500
    assert first[:, 0].max() < 5.3
    inside = (first[:, 0] <= 0.0) & (first[:, 0] >= -4.5) & (np.abs(first[:, 1]) <= 0.9)
    assert not inside.any()


@pytest.mark.parametrize("speed", [0.0, 1.4])
def test_they_stand_or_walk_straight_on(speed: float) -> None:
    found = places(sight(false_rate=5.0, false_speed=speed), 400)
    for there in found.values():
        moves = np.diff(there, axis=0)
        assert np.allclose(np.hypot(*moves.T), speed * STEP)
        assert np.allclose(moves, moves[:1])
    whole = look(sight(false_rate=10.0, false_speed=speed), 0).people
    assert np.allclose(whole.desired_speed, speed)


def test_the_same_seed_has_the_same_ones_relative_to_the_cameras_wherever_the_ego_drives() -> None:
    def first(seed: int, own: OwnState) -> Any:
        found = places(sight(seed=seed, false_rate=3.0), 400, own=own)
        return np.array([there[0] for there in found.values()]) - own.pose[:2]

    elsewhere = replace(OWN, pose=Pose(70.0, -3.0, 0.0))
    assert np.array_equal(first(1, OWN), first(1, OWN))
    assert np.allclose(first(1, OWN), first(1, elsewhere), atol=1e-9)
    assert first(1, OWN).shape != first(2, OWN).shape or (first(1, OWN) != first(2, OWN)).all()


def test_they_are_perceived_late_and_remembered_as_people_are() -> None:
    sensor = sight(false_rate=0.4, false_time=0.5, latency=0.2, memory=1.0, acceleration=3.0)
    percepts = [look(sensor, step) for step in range(400)]
    shown = [step for step, percept in enumerate(percepts) if -1 in percept.person_ids]
    assert len(shown) == 10 + 20  # 0.5 s, and then 1 s in memory
    ages = [percepts[step].age[percepts[step].person_ids == -1][0] for step in shown]
    assert ages[:10] == pytest.approx([0.2] * 10)
    assert ages[-1] == pytest.approx(1.2)
    bound = percepts[shown[-1]].position_bound[percepts[shown[-1]].person_ids == -1][0]
    assert bound == pytest.approx(0.5 * 3.0 * 1.2**2)


def test_misses_and_noise_of_people_are_the_same_with_and_without_them() -> None:
    people = Crowd.create([[9.0, 0.0], [20.0, 2.0]], np.zeros((2, 2)), 1.3, [[[9.0, 9.0]]] * 2)

    def seen(**options: Any) -> Any:
        sensor, found = sight(missed=0.3, position_noise=0.2, **options), []
        for step in range(200):
            heights = np.array([1.5]), np.full(2, 1.7)
            truth = Truth(people, BODY, NO_WALLS, STEP * step, *heights)
            percept = sensor.observe(truth, np.arange(2), OWN)
            real = percept.person_ids >= 0
            found += [percept.person_ids[real], percept.people.position[real].ravel()]
        return np.concatenate(found)

    assert np.array_equal(seen(), seen(false_rate=4.0))


@given(st.lists(st.integers(-(2**40), 2**40), unique=True))
def test_numbers_of_the_chain_are_not_negative_unique_and_lead_back_to_ids(some: list[int]) -> None:
    ids = np.array(some, dtype=np.int64)
    tracks = tracks_of(ids)
    assert (tracks >= 0).all()
    assert len(np.unique(tracks)) == len(ids)
    assert (ids_of(tracks) == ids).all()


def test_the_whole_chain_follows_people_and_false_detections_apart() -> None:
    config = EgoRunConfig(
        perception={
            "sensor": "sight", "tracker": True, "position_noise": 0.1,
            "desired_speeds": "typical", "goals": "heading",
        },
        sensor_options={"false_rate": 10.0, "false_speed": 1.0},
    )  # fmt: skip
    perception = Perception(config, 3.0, STEP)
    people = Crowd.create([[9.0, 0.0]], [[0.0, 0.5]], 1.3, [[[9.0, 9.0]]])
    known = set()
    for step in range(200):
        heights = np.array([1.5]), np.full(1, 1.7)
        truth = Truth(people, BODY, NO_WALLS, STEP * step, *heights)
        percept = perception.observe(truth, np.array([7]), OWN)
        ids = perception.ids(percept)
        assert ids[0] == 7
        assert (ids[1:] < 0).all()
        assert np.isfinite(percept.people.position).all()
        assert len(percept.people) == len(percept.position_bound) == len(percept.velocity_bound)
        known |= set(ids[1:].tolist())
    assert known == set(range(-len(known), 0))
    assert len(known) > 200


def test_a_sensor_with_false_detections_keeps_to_the_rules_of_sensors() -> None:
    options = {"false_rate": 5.0, "false_speed": 1.4, "latency": 0.1, "position_noise": 0.1}
    setup = SensorSetup(STEP, 1, "ego")
    findings = check_sensor(lambda made: Sight(made, SightOptions(**options)), setup)
    assert not [finding for finding in findings if finding.problem]


def test_a_sensor_of_another_package_says_that_it_has_them() -> None:
    class Invents:
        false_detections = True
        number = -1

        def observe(self, truth: Truth, person_ids: Any, ego: OwnState) -> Percept:
            return Percept(truth.people, np.array([self.number]))

    somebody = Crowd.create([[9.0, 0.0]], [[0.0, 0.5]], 1.3, [[[9.0, 9.0]]])
    sensor = PluggedInSensor("it", Invents)
    assert sensor.observe(Truth.of_people(somebody), np.array([4]), OWN).person_ids == [-1]
    Invents.number = -(10**9)
    with pytest.raises(SensorError, match="person_ids with -1000000000"):
        sensor.observe(Truth.of_people(somebody), np.array([4]), OWN)


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("false_rate", -1.0, r"a finite number >= 0 \[1/s\]"),
        ("false_rate", 11.0, r"at most 10 \[1/s\]"),
        ("false_rate", float("nan"), "a finite number"),
        ("false_time", 0.0, r"a finite number > 0 \[s\]"),
        ("false_speed", float("inf"), r"a finite number >= 0 \[m/s\]"),
    ],
)
def test_options_out_of_range_are_refused(name: str, value: float, expected: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} = {value}: expected {expected}"):
        SightOptions(**{name: value})
