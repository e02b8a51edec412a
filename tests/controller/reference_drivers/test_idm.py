"""The reference driver: the published model's equilibrium and stops, and whose way it accepts."""

from types import SimpleNamespace

import numpy as np
import pytest

from controller import Observation, ParameterError, Setup
from controller.reference_drivers.idm import IdmOptions, IntelligentDriver

SETUP = Setup(0.05, 1500.0, 100.0, 10.0, 8.0, 12000.0, 2.0)


class Straight:
    def remaining(self):
        return 1e3

    def poses(self, distances):
        return np.column_stack([distances, np.zeros((len(distances), 2))])


def person(x, y, v_y=0.0):
    return SimpleNamespace(position=np.array([[x, y]]), velocity=np.array([[0.0, v_y]]))


def answer(speed, **seen):
    driver = IntelligentDriver(SETUP, IdmOptions())
    return driver.control(Observation(0.0, speed, np.inf, np.empty(0), path=Straight(), **seen))


def test_at_the_wanted_speed_and_equilibrium_gap_it_stays_steady():
    assert answer(10.0) == (pytest.approx(0.0), "free")
    assert answer(0.0).value == pytest.approx(1.0)
    # behind a leader as fast as itself the improved model keeps s_0 + v T, not more
    assert answer(6.0, leader_gap=8.0, leader_speed=6.0) == (pytest.approx(0.0), "vehicle")
    assert answer(6.0, leader_gap=7.0, leader_speed=6.0).value < 0.0
    assert answer(12.0).value < 0.0


@pytest.mark.parametrize("speed", [4.0, 8.0, 12.0])
@pytest.mark.parametrize("seen", ["stop_gap", "leader_gap"])
def test_it_stops_gently_before_a_line_and_behind_a_leader(speed, seen):
    driver = IntelligentDriver(SETUP, IdmOptions())
    x, v, hardest = 0.0, speed, 0.0
    for _ in range(1200):
        gap = {seen: 60.0 - x}
        a = driver.control(Observation(x, v, np.inf, np.empty(0), **gap)).value
        hardest, after = max(hardest, -a), max(0.0, v + 0.05 * a)
        x, v = x + 0.025 * (v + after), after
    kept = {"stop_gap": 0.5, "leader_gap": 2.0}[seen]
    assert 60.0 - x == pytest.approx(kept, abs=0.35)
    assert hardest < 2.6


@pytest.mark.parametrize(
    ("who", "reason"),
    [
        (person(15.0, 0.0), "person"),  # stands on its way
        (person(15.0, 5.0, -1.4), "person"),  # will be there when it is
        (person(15.0, 5.0, 1.4), "free"),  # goes away
        (person(15.0, 5.0), "free"),  # stands beside it
        (person(15.0, -12.0, 1.4), "free"),  # comes when it has passed
        (person(35.0, -2.0, 1.4), "free"),  # will have left
        (person(-3.0, 0.0), "free"),  # is behind
    ],
)
def test_whose_way_it_is(who, reason):
    assert answer(8.0, people=who).reason == reason


@pytest.mark.parametrize(("y", "reason"), [(-9.0, "free"), (-7.0, "person")])
def test_at_rest_it_accepts_a_gap_that_it_clears_in_time(y, reason):
    # 3 m to the person's place and 4.5 m of vehicle, at 1 m/s^2 from rest: 3.9 s, and 1 s of margin
    assert answer(0.0, people=person(3.0, y, 1.4)).reason == reason


@pytest.mark.parametrize(
    ("name", "value"), [("acceleration", 0.0), ("headway", -1.0), ("exponent", np.nan)]
)
def test_a_driver_that_cannot_be_is_refused(name, value):
    with pytest.raises(ParameterError, match=name):
        IdmOptions(**{name: value})


def test_a_limit_that_falls_before_a_bend_is_followed():
    x, v, over = 0.0, 10.0, 0.0
    driver = IntelligentDriver(SETUP, IdmOptions())
    for _ in range(200):  # the limit falls with 2 m/s^2 down to 4 m/s, told 0.3 s ahead
        limit = np.sqrt(max(16.0, 100.0 - 4.0 * (x + 0.3 * v)))
        a = driver.control(Observation(x, v, np.inf, np.empty(0), speed_limit=limit)).value
        assert a >= -4.0
        x, v = x + 0.05 * (v + 0.025 * a), v + 0.05 * a
        over = max(over, v - np.sqrt(max(16.0, 100.0 - 4.0 * x)))
    assert over < 0.6
    assert v == pytest.approx(4.0, abs=0.1)
