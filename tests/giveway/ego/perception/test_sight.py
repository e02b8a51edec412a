"""The sensor sight: who is perceived, how late, how exactly, and where people may be hidden."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from controller.parameters import ParameterError
from giveway.ego.perception import OwnState, Percept, SensorSetup, Truth
from giveway.ego.perception.conformance import check_sensor
from giveway.ego.perception.sight import Mount, Sight, SightOptions
from giveway.errors import ConfigError
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from giveway.plug_ins.options import read_options
from giveway.plug_ins.sockets import SENSOR
from pedestrian_model import Crowd

STEP = 0.05
SETUP = SensorSetup(STEP, 1, "ego")
OWN = OwnState(Pose(0.0, 0.0, 0.0), 8.0, 0, VehicleShape(4.5, 1.8))
EGO = -2.25, 0.0, 0.0, 8.0, 2.25, 2.25, 1.8
PARKED = 8.0, -2.9, 0.0, 0.0, 2.25, 2.25, 1.8  # right of the way, its front at x = 10.25 m
TALL, SMALL = 1.75, 1.15


def crowd(*places: tuple[float, float], velocity: tuple[float, float] = (0.0, 1.0)) -> Crowd:
    n = len(places)
    goals = [[(x, y + 20.0)] for x, y in places]
    return Crowd.create(list(places), [velocity] * n, 1.3, goals) if n else Crowd.empty()


def truth(people: Crowd, *, height: float = SMALL, time: float = 0.0, car: Any = PARKED) -> Truth:
    vehicles = np.array([EGO, car])
    tops = np.array([1.5, 1.5]), np.full(len(people), height)
    return Truth(people, vehicles, np.empty((0, 5)), time, *tops)


def ids(people: Crowd) -> Any:
    return np.arange(len(people), dtype=np.int64)


def sight(**options: Any) -> Sight:
    return Sight(SETUP, SightOptions(mounts=(Mount(),), **options))


def look(sensor: Sight, people: Crowd, **about: Any) -> Percept:
    return sensor.observe(truth(people, **about), ids(people), OWN)


BEHIND = (11.0, -3.0)  # behind the parked car, as seen from the windscreen
OPEN = (11.0, 1.0)


def test_a_parked_car_hides_a_child_until_it_steps_out() -> None:
    sensor = sight()
    assert look(sensor, crowd(BEHIND, OPEN)).person_ids.tolist() == [1]
    assert look(sensor, crowd((11.0, -0.9), OPEN)).person_ids.tolist() == [0, 1]


def test_an_adult_is_seen_over_a_parked_car() -> None:
    assert len(look(sight(), crowd(BEHIND), height=TALL).person_ids) == 1


def test_cameras_on_the_mirrors_see_beside_the_car() -> None:
    beside = crowd((0.0, 3.0), (-3.0, -4.0))
    assert not len(look(sight(), beside).person_ids)
    usual = Sight(SETUP, SightOptions())
    assert len(look(usual, beside).person_ids) == 2


def test_people_hide_each_other_only_if_they_are_to() -> None:
    row = crowd((8.0, 0.0), (12.0, 0.0))
    assert len(look(sight(), row, height=TALL).person_ids) == 2
    assert look(sight(people_hide=True), row, height=TALL).person_ids.tolist() == [0]


def test_who_is_lost_from_sight_is_remembered_for_a_while() -> None:
    sensor, known = sight(memory=0.5), []
    look(sensor, crowd(OPEN))
    for step in range(1, 15):
        percept = look(sensor, crowd((11.0, -3.0 + STEP * step)), time=STEP * step)
        known.append(len(percept.person_ids))
        if len(percept.person_ids):
            where = percept.people.position[0]
            assert where == pytest.approx((11.0, 1.0 + STEP * step))  # walks on as when seen
            assert percept.age == pytest.approx(STEP * step)
    assert known[:10] == [1] * 10
    assert not any(known[10:])


def test_latency_moves_people_on_and_widens_their_bounds() -> None:
    sensor, late = sight(latency=0.2, acceleration=3.0), 4
    for step in range(12):
        place = 11.0, 1.0 + STEP * step
        percept = look(sensor, crowd(place), time=STEP * step)
        if step < late:
            assert not len(percept.person_ids)
            continue
        assert percept.people.position[0] == pytest.approx(place)
        assert percept.age == pytest.approx(0.2)
        assert percept.position_bound == pytest.approx(0.5 * 3.0 * 0.2**2)
        assert percept.velocity_bound == pytest.approx(0.6)


@pytest.mark.parametrize("share", [0.1, 0.4])
def test_people_are_missed_for_the_share_and_time_that_are_asked_for(share: float) -> None:
    sensor = sight(missed=share, missed_time=0.5, memory=0.0)
    everybody = crowd(*[(10.0 + 0.2 * k, 1.0 + 0.1 * k) for k in range(20)])
    seen = np.zeros((4000, 20), dtype=np.bool_)
    for step in range(len(seen)):
        seen[step, look(sensor, everybody, time=STEP * step).person_ids] = True
    assert 1.0 - seen.mean() == pytest.approx(share, abs=0.03)
    gone = np.flatnonzero(np.diff(seen[:, 0].astype(int)))
    stretches = np.diff(gone)[~seen[gone[:-1] + 1, 0]]
    assert stretches.min() == 10  # 0.5 s


def test_noise_grows_with_distance_and_keeps_to_its_bounds() -> None:
    sensor = sight(position_noise=0.05, noise_per_metre=0.01, velocity_noise=0.1)
    people, off = crowd((5.0, 0.0), (40.0, 0.0)), []
    for step in range(400):
        percept = look(sensor, people, time=STEP * step)
        error = percept.people.position - people.position
        turned = percept.people.velocity - people.velocity
        assert (np.hypot(*error.T) <= percept.position_bound).all()
        assert (np.hypot(*turned.T) <= percept.velocity_bound).all()
        off.append(error)
    deviation = np.std(off, axis=(0, 2))
    assert deviation == pytest.approx(0.88 * np.array([0.1, 0.45]), rel=0.15)


def points(*places: tuple[float, float]) -> Array:
    return np.array(places)


def test_hiding_places_are_behind_what_stands_and_beyond_the_range() -> None:
    sensor = sight()
    look(sensor, crowd())
    marks = sensor.unseen(points((11.0, -3.0), (11.0, 1.0), (58.0, 0.0), (59.0, 0.0)))
    assert marks.tolist() == [True, False, False, True]


def test_nobody_is_expected_behind_moving_cars_or_people() -> None:
    sensor = sight(people_hide=True)
    look(sensor, crowd((8.0, 0.0)), car=(*PARKED[:3], 5.0, *PARKED[4:]))
    assert not sensor.unseen(points((11.0, -3.0), (12.0, 0.0))).any()


def test_walls_hide_people_too() -> None:
    sensor, people = sight(), crowd((20.0, 5.0))
    wall = np.array([[10.0, 3.0, 18.0, 3.0, 3.0]])
    percept = sensor.observe(replace(truth(people), outlines=wall), ids(people), OWN)
    assert not len(percept.person_ids)
    assert sensor.unseen(points((20.0, 5.0))).all()


@pytest.mark.parametrize("options", [{}, {"latency": 0.1, "position_noise": 0.1, "missed": 0.2}])
def test_it_keeps_to_the_rules_of_sensors(options: dict[str, float]) -> None:
    findings = check_sensor(lambda setup: Sight(setup, SightOptions(**options)), SETUP)
    assert not [finding for finding in findings if finding.problem]


@pytest.mark.parametrize(
    ("name", "value"), [("missed", 1.0), ("latency", -0.1), ("missed_time", 0.0), ("mounts", ())]
)
def test_options_out_of_range_are_refused(name: str, value: Any) -> None:
    with pytest.raises(ParameterError, match=name):
        SightOptions(**{name: value})


@pytest.mark.parametrize("name", ["height", "range", "field_of_view"])
def test_a_camera_without_extent_is_refused(name: str) -> None:
    with pytest.raises(ParameterError, match=name):
        Mount(**{name: 0.0})
    with pytest.raises(ParameterError, match="at most 360"):
        Mount(field_of_view=361.0)


@pytest.mark.parametrize(
    ("mount", "said"),
    [
        ({"height": True}, "mounts.0.height = True"),
        ({"ahed": 1.0}, "mounts.0.ahed"),
        ({"range": 0.0}, "range"),
        ({"ahead": float("inf")}, "ahead"),
    ],
)
def test_a_camera_that_is_not_one_is_refused_by_name(mount: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        read_options("sight", SightOptions, {"mounts": [mount]}, SENSOR)


def test_cameras_are_tables_of_the_options() -> None:
    options = read_options("sight", SightOptions, {"mounts": [{"height": 2}, {}]}, SENSOR)
    assert options.mounts == (Mount(height=2.0), Mount())
