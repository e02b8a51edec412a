"""The planner with the crowd's answer: what it waits for, what it expects people to do."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

from controller import Observation, ParameterError, Setup
from controller.errors import PlugInError
from controller.reference_drivers.bilevel import BilevelMpc, BilevelOptions

SETUP = Setup(0.05, 1000.0, 100.0, 4.0, 8.0, 8000.0, 2.0)


class Turned:
    """A straight path that leads to the north from (10, 0)."""

    def remaining(self):
        return 1e3

    def poses(self, distances):
        ones = np.ones(len(distances))
        return np.column_stack([10.0 * ones, distances, np.pi / 2.0 * ones])


def people(*rows):
    """People by station, lateral offset to the left, and their rates."""
    found = np.array(rows, dtype=float).reshape(-1, 4)
    position = np.column_stack([10.0 - found[:, 1], found[:, 0]])
    return SimpleNamespace(position=position, velocity=np.column_stack([-found[:, 3], found[:, 2]]))


def answers(speed, crowd, *, steps=4, options=None, **seen):
    """The accelerations of the first steps."""
    driver = BilevelMpc(SETUP, options or BilevelOptions())
    observation = Observation(0.0, speed, people=crowd, path=Turned(), **seen)
    return [driver.control(observation) for _ in range(steps)]


def driven(crowd, seconds, **options):
    """Station and speed after a drive among people who never avoid it."""
    driver, station, speed = BilevelMpc(SETUP, BilevelOptions(**options)), 0.0, 4.0
    for _ in range(round(seconds / 0.05)):
        moved = crowd - [station, 0.0, 0.0, 0.0]
        seen = Observation(station, speed, people=people(*moved), path=Turned())
        speed = max(0.0, speed + 0.05 * driver.control(seen).value)
        station += 0.05 * speed
        crowd = crowd + 0.05 * np.pad(crowd[:, 2:], [(0, 0), (0, 2)])
    assert driver.failures == 0
    return station, speed


@pytest.fixture
def _casadi():
    pytest.importorskip("casadi")


@pytest.mark.usefixtures("_casadi")
def test_alone_it_approaches_the_reference_speed():
    assert answers(4.0, None)[-1].value == pytest.approx(0.0, abs=1e-3)
    assert answers(2.0, None)[-1].value > 0.3
    assert answers(4.0, None)[-1].reason == "free"


@pytest.mark.usefixtures("_casadi")
def test_it_stops_before_a_person_who_stands_on_the_way():
    station, speed = driven(np.array([[25.0, 0.0, 0.0, 0.0]]), 20.0)
    assert speed < 0.3
    assert 21.0 < station < 24.8


@pytest.mark.usefixtures("_casadi")
@pytest.mark.parametrize(("station", "across"), [(12.0, 1.4), (8.0, 1.4)])
def test_courtesy_makes_it_wait_for_who_comes(station, across):
    crowd = np.array([[station, -4.0, 0.0, across]])
    polite, _ = driven(crowd, 2.0, courtesy=100.0)
    rude, _ = driven(crowd, 2.0, courtesy=0.0, share=1.0)
    assert polite < rude


@pytest.mark.usefixtures("_casadi")
def test_who_walks_away_or_is_behind_does_not_count():
    free = answers(4.0, None)[-1].value
    for row in ([10.0, 3.0, 0.0, 1.4], [-9.0, 0.0, 0.0, 0.0], [60.0, 0.0, 0.0, 0.0]):
        answer = answers(4.0, people(row))[-1]
        assert answer.reason == "free"
        assert answer.value == pytest.approx(free, abs=1e-9)


@pytest.mark.usefixtures("_casadi")
def test_it_stops_at_a_line_and_behind_a_leader():
    for seen in ({"stop_gap": 6.0}, {"leader_gap": 7.0, "leader_speed": 0.0}):
        assert answers(4.0, None, **seen)[-1].value < -1.0


@pytest.mark.usefixtures("_casadi")
def test_the_acceleration_is_on_a_ramp_between_two_plans():
    values = [one.value for one in answers(0.0, None, steps=4)]
    assert np.diff(values) == pytest.approx(values[0], rel=1e-9)


@pytest.mark.usefixtures("_casadi")
def test_reset_makes_it_drive_as_if_new():
    crowd = people([9.0, 3.0, 0.0, -1.4], [12.0, -3.0, 0.0, 1.2])
    driver = BilevelMpc(SETUP, BilevelOptions())
    seen = Observation(0.0, 4.0, people=crowd, path=Turned())
    first = [driver.control(seen).value for _ in range(9)]
    driver.reset()
    assert [driver.control(seen).value for _ in range(9)] == first
    assert driver.solves == 3


@pytest.mark.usefixtures("_casadi")
def test_without_a_solution_it_brakes_comfortably_and_counts():
    driver = BilevelMpc(SETUP, BilevelOptions(iterations=1))
    crowd = people([9.0, 3.0, 0.0, -1.4], [12.0, -3.0, 0.0, 1.2])
    seen = Observation(0.0, 4.0, people=crowd, path=Turned())
    for _ in range(4):
        answer = driver.control(seen)
    assert (answer.value, answer.reason) == (-2.0, "no solution")
    assert (driver.solves, driver.failures) == (1, 1)


def test_without_casadi_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "casadi", None)
    with pytest.raises(PlugInError, match=r"needs CasADi, .*; pip install 'giveway\[sicnav\]'"):
        answers(4.0, None)


@pytest.mark.parametrize(
    ("name", "value"), [("step", 0.0), ("margin", -0.1), ("people", 0), ("courtesy", np.nan)]
)
def test_a_driver_that_cannot_be_is_refused(name, value):
    with pytest.raises(ParameterError, match=name):
        BilevelOptions(**{name: value})
