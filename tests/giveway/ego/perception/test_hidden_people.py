"""Hiding places along a path, and the child that runs out of one at the worst moment."""

from math import inf, pi

import numpy as np
import pytest

from controller import Decision, SafetyParameters
from giveway.config import EgoRunConfig
from giveway.ego.perception import OwnState, SensorSetup, Truth
from giveway.ego.perception.hidden_people import ERROR, Hidden, HidingPlaces, fill_free
from giveway.ego.perception.sight import Sight, SightOptions
from giveway.ego.perception.visibility import CHILD, RADIUS, walls_of
from giveway.ego.rules.hidden_people import CRAWL, HiddenPeople
from giveway.ego.rules.protocol import Situation
from giveway.ego.safety_layer import RUSHES, EgoSafetyLayer
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath, Pose
from pedestrian_model import Crowd

STEP, SHAPE = 0.05, VehicleShape(4.5, 1.8)
PATH = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
HALF = SHAPE.width / 2.0
CHILD_RUNS = 1.39


def parked(x: float, y: float = -2.8) -> tuple[float, ...]:
    """A parked car by its middle, 1 m beside the ego."""
    return x, y, 0.0, 0.0, 2.25, 2.25, 1.8


CARS = tuple(parked(x) for x in (18.0, 23.5, 30.0))  # the gap is at x = 25.75 to 27.75 m


def truth(
    front: float, speed: float, *cars: tuple[float, ...], people: Crowd | None = None
) -> Truth:
    ego = front - SHAPE.length / 2.0, 0.0, 0.0, speed, 2.25, 2.25, SHAPE.width
    people = Crowd.empty() if people is None else people
    tops = np.full(1 + len(cars), 1.5), np.full(len(people), CHILD)
    return Truth(people, np.array([ego, *cars]), np.empty((0, 5)), 0.0, *tops)


def own(front: float, speed: float) -> OwnState:
    return OwnState(Pose(front, 0.0, 0.0), speed, 0, SHAPE)


def hiding(front: float, speed: float, *cars: tuple[float, ...]) -> Hidden:
    sensor, world = Sight(SensorSetup(STEP, 1, "ego"), SightOptions()), truth(front, speed, *cars)
    sensor.observe(world, np.empty(0, np.int64), own(front, speed))
    return HidingPlaces(PATH, CHILD_RUNS).ahead(sensor, world, 0, front, speed)


def test_an_open_road_has_no_hiding_places() -> None:
    assert not len(hiding(20.0, 8.0).station)


def test_behind_a_parked_car_is_a_hiding_place() -> None:
    found = hiding(20.0, 8.0, parked(30.0))
    assert found.station.min() == pytest.approx(32.25, abs=0.5)  # nowhere beside the car or before
    nearest = found.aside[np.argmin(found.station)]
    assert (
        1.9 < nearest < 2.6
    )  # its side is 1.9 m from the path; the line of sight opens from there
    assert (found.position[:, 1] < 0.0).all()


def test_each_place_is_unseen_and_what_is_nearer_is_seen() -> None:
    sensor, world = (
        Sight(SensorSetup(STEP, 1, "ego"), SightOptions()),
        truth(20.0, 8.0, parked(30.0)),
    )
    sensor.observe(world, np.empty(0, np.int64), own(20.0, 8.0))
    found = HidingPlaces(PATH, CHILD_RUNS).ahead(sensor, world, 0, 20.0, 8.0)
    for change, hides in ((0.03, True), (-0.03, False)):
        points = np.column_stack([found.station, -(found.aside + change)])
        assert (sensor.unseen(points) == hides).all()


def test_nobody_comes_out_through_a_car_or_a_wall() -> None:
    poses = np.array([[30.0, 0.0, 0.0], [40.0, 0.0, 0.0]])
    wall = np.array([[25.0, -3.0, 35.0, -3.0, 2.0], [25.0, 4.0, 35.0, 2.0, 2.0]])
    free = np.empty((2, 2))
    assert fill_free(poses, wall, np.empty((0, 7)), free) == 2
    assert free.tolist() == [[3.0, 3.0], [inf, inf]]


def test_nothing_is_looked_for_beyond_a_vehicle_on_the_way() -> None:
    poses = np.array([[x, 0.0, 0.0] for x in (30.0, 34.0, 38.0)])
    standing = np.array([[34.0, 0.5, pi / 2, 0.0, 1.0, 1.0, 3.0]])
    assert fill_free(poses, np.empty((0, 5)), standing, np.empty((3, 2))) == 1


def rule(speed: float = 1.39, late: float = 0.0) -> HiddenPeople:
    return HiddenPeople(speed, 0.6, HALF, 8.0, late, STEP * np.arange(1.0, 21.0))


def place(ahead: float, gap: float) -> Hidden:
    aside = HALF + RADIUS + gap
    return Hidden(np.array([[ahead, -aside]]), np.array([ahead]), np.array([aside]))


@pytest.mark.parametrize(("gap", "slowest"), [(0.3, CRAWL), (1.0, 4.0), (3.0, 11.9)])
def test_before_a_place_the_speed_is_one_from_which_a_stop_is_in_time(
    gap: float, slowest: float
) -> None:
    situation = Situation(station=0.0, speed=1.0, hidden=place(2.0, gap))
    assert rule().demand(situation).speed == pytest.approx(slowest, abs=0.15)


def test_late_brakes_ask_for_a_lower_speed() -> None:
    situation = Situation(station=0.0, speed=1.0, hidden=place(2.0, 1.0))
    usual, slow = (rule(late=late).demand(situation).speed for late in (0.0, 0.2))
    assert usual - slow == pytest.approx(8.0 * 0.2)


def test_far_before_it_the_ego_slows_down_comfortably() -> None:
    near, far = (rule().demand(Situation(hidden=place(d, 1.0))).speed for d in (6.0, 26.0))
    assert far**2 - near**2 == pytest.approx(2.0 * 2.0 * 20.0)


def test_the_speeds_ahead_are_those_of_the_places_that_are_still_ahead() -> None:
    speeds = rule().demand(Situation(station=0.0, speed=4.0, hidden=place(2.0, 1.0))).lane_speeds
    assert (np.diff(speeds[:9]) <= 1e-9).all()
    assert (speeds[10:] == inf).all()  # 2 m are driven within 0.5 s


def test_a_place_that_comes_in_sight_at_once_is_slowed_down_for_comfortably() -> None:
    demand = rule().demand(Situation(station=0.0, speed=8.0, hidden=place(6.0, 0.5)))
    assert demand.speed == 8.0
    assert demand.lane_speeds[:9] == pytest.approx(8.0 - 2.0 * STEP * np.arange(1.0, 10.0))


def test_without_places_nothing_is_demanded() -> None:
    assert rule().demand(Situation()) is None


class ChildRunsOut:
    """A drive past parked cars by a controller that never brakes, and a child that runs out.

    Args:
        hidden_speed: Speed [m/s] that the layer expects of people who come out of hiding.
        running: Speed [m/s] of the child.
    """

    def __init__(self, hidden_speed: float, running: float) -> None:
        self._running = running
        self.config = EgoRunConfig.model_validate(
            {
                "controller": "mpc",
                "perception": {"sensor": "sight"},
                "safety": {"hidden_speed": hidden_speed},
            }
        )
        _, self._alone = self._drive(np.array([0.0, 50.0]), np.zeros(2), inf)

    def impact(self, x: float, y: float, turn: float, ahead: float) -> float:
        """Return the speed [m/s] at which the front hits the child, or 0.

        Args:
            x: Station [m] at which the child gets to the side of the ego.
            y: Place [m] aside at which it begins to run.
            turn: Angle [rad] of its way to the way across.
            ahead: Distance [m] of the front to that station then, if the ego went on.
        """
        velocity = self._running * np.array([np.sin(turn), np.cos(turn)])
        duration = (-HALF - RADIUS - y) / velocity[1]
        start = np.array([x - velocity[0] * duration, y])
        begin = float(np.interp(x - ahead, *self._alone)) - duration
        return self._drive(start, velocity, begin)[0]

    def _drive(
        self, start: Array, velocity: Array, begin: float
    ) -> tuple[float, tuple[list[float], list[float]]]:
        """Drive; return the speed of the impact, and the stations and times of the front."""
        limits = SafetyParameters(force_limit=8000.0)
        layer = EgoSafetyLayer(limits, self.config, PATH, SHAPE, STEP)
        sensor, places = (
            Sight(SensorSetup(STEP, 1, "ego"), SightOptions()),
            HidingPlaces(PATH, CHILD_RUNS),
        )
        vehicle, front, speed = self.config.vehicle, 12.0, 4.0
        fronts, times = [], []
        for step in range(150):
            time = STEP * step
            fronts.append(front)
            times.append(time)
            moves = time >= begin
            at = start + (time - begin) * velocity if moves else start
            child = Crowd.create([at], [velocity * moves], 1.4, [[at + 20.0 * velocity]])
            world = truth(front, speed, *CARS, people=child)
            percept = sensor.observe(world, np.zeros(1, np.int64), own(front, speed))
            in_sight = len(percept.person_ids) and at[1] < 0.0
            if front > 29.0 or (in_sight and not moves):
                break  # past the gap, or the child did not hide
            ahead, aside = at[0] - front, max(0.0, abs(at[1]) - HALF)
            if ahead > 0.0 and np.hypot(ahead, aside) < RADIUS:
                return speed, (fronts, times)
            asked = Decision(3000.0, "never brakes", "", "", 0, 8.0, None)
            hidden = places.ahead(sensor, world, 0, front, speed)
            safe = layer.overrule(asked, front, speed, percept, hidden=hidden)
            force = (safe or asked).force
            after = max(0.0, speed + STEP * (force - vehicle.friction * speed) / vehicle.mass)
            front, speed = front + 0.5 * STEP * (speed + after), after
        return 0.0, (fronts, times)


def worst(hidden_speed: float, tries: int, running: float = CHILD_RUNS) -> float:
    """The fastest impact [m/s] that an adversary finds who searches place, way and moment."""
    random, drive = np.random.default_rng(7), ChildRunsOut(hidden_speed, running)
    best, found = 0.0, np.array([26.8, -2.4, 0.0, 1.0])
    spread = np.array([1.0, 0.5, 0.5, 1.0])
    for k in range(tries):
        scale = 1.0 if k < tries // 2 else 0.3
        tried = found + scale * spread * random.uniform(-1.0, 1.0, 4)
        speed = drive.impact(*tried)
        if speed > best:
            best, found = speed, tried
    return best


def test_within_the_assumption_no_child_is_hit_faster_than_at_walking_pace() -> None:
    assert worst(CHILD_RUNS, 16) <= RUSHES


def test_beyond_it_the_adversary_finds_a_child_that_is_hit() -> None:
    assert worst(0.0, 16, 3.0) > RUSHES


@pytest.mark.parametrize("front", [16.0, 19.03, 21.3, 23.71, 24.9, 25.2, 25.44, 25.6, 25.68])
def test_nobody_who_is_hidden_is_nearer_than_the_places_say(front: float) -> None:
    """Brute force: all points 2 cm apart at which a child could stand unseen and come out."""
    sensor, world = Sight(SensorSetup(STEP, 1, "ego"), SightOptions()), truth(front, 6.0, *CARS)
    sensor.observe(world, np.empty(0, np.int64), own(front, 6.0))
    found = HidingPlaces(PATH, CHILD_RUNS).ahead(sensor, world, 0, front, 6.0)
    stations = np.arange(front, front + 5.5, 0.02)
    poses = np.column_stack([stations, np.zeros((len(stations), 2))])
    free, walls = (
        np.empty((len(poses), 2)),
        walls_of(world.outlines, world.vehicles, world.vehicle_heights, 0)[0],
    )
    fill_free(poses, walls, world.vehicles[1:], free)
    aside = np.arange(0.0, 3.5, 0.02)
    points = np.column_stack([np.repeat(stations, len(aside)), -np.tile(aside, len(stations))])
    hides = sensor.unseen(points).reshape(len(stations), len(aside)) & (aside < free[:, 1:])
    for row in np.flatnonzero(hides.any(axis=1)):
        nearest = aside[hides[row].argmax()]
        beside = np.abs(found.station - stations[row]) <= 0.125
        assert found.aside[beside].min(initial=inf) <= nearest + ERROR
