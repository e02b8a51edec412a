"""The gaps that people at a kerb accept, and how long they wait for one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from giveway.crowd.gap_acceptance import Approaches, GapAcceptance, accepts
from giveway.crowd.roster import Roster
from giveway.sumo.network.pedestrian_crossings import Crossing
from giveway.sumo.persons.gap_habits import GapHabit
from pedestrian_model import Crowd

LENGTH, PACE, SPEED = 6.4, 1.25, 13.9
HABIT = GapHabit(3.0, 0.0, 0.0, 0.0, 0.0)
ROAD = Crossing(":m_c0_0", np.array([(0.0, 0.0), (0.0, LENGTH)]), 4.0, False, "", -1)


def arriving(*entry: float, speed: float = SPEED, yields: float = 0.0) -> Approaches:
    """Cars of 5 m on the far lane, ``entry`` [m] before a crossing of 4 m."""
    here = np.array(entry)
    lane = np.ones_like(here)
    return Approaches(here, here + 9.0, speed * lane, yields * lane, 3.2 * lane, LENGTH * lane)


def takes(cars: Approaches, *, impatience: float = 0.0, away: float = 0.0) -> list[bool]:
    """Whether a person accepts the gap before each car."""
    one = np.ones(1)
    clear = np.full((1, len(cars.entry)), LENGTH + away)
    found = accepts(away * one, clear, PACE * one, 3.0 * one, impatience * one, cars)
    return found[0].tolist()


def test_critical_headway_is_that_of_the_highway_capacity_manual() -> None:
    critical = LENGTH / PACE + 3.0
    near, far = SPEED * (critical - 0.01), SPEED * (critical + 0.01)
    assert takes(arriving(near, far)) == [False, True]
    assert takes(arriving(near, far, 5.0 * near), away=1.0) == [False, False, True]
    assert takes(arriving(-9.1, -8.9)) == [True, False]  # its rear has left the crossing, or not


def test_waiting_makes_bolder_down_to_the_time_in_which_a_car_can_stop() -> None:
    floor = 1.0 + SPEED / 6.8
    cars = arriving(SPEED * (floor - 0.01), SPEED * (floor + 0.01))
    assert takes(cars, impatience=0.9) == [False, False]
    assert takes(cars, impatience=1.0) == [False, True]
    turning = cars._replace(yields=np.ones(2))  # has to give way to people anyhow
    assert takes(turning) == [False, True]


def at_the_kerb(
    count: int, *habits: GapHabit, step: float = 0.1, seed: int = 1
) -> tuple[GapAcceptance, Roster]:
    """People who wait beside each other."""
    people = Crowd.create(
        [(0.4 * i, -0.4) for i in range(count)],
        [(0.0, 0.0)] * count,
        [PACE] * count,
        [[(0.4 * i, -0.4), (0.4 * i, LENGTH + 0.4)] for i in range(count)],
        passages=[[(0.0, 1.0, 3.0)] * 2] * count,
        signals=[[0, -1]] * count,
    )
    names = [f"p{i}" for i in range(count)]
    roster = Roster()
    roster.take_in(names, people)
    gaps = GapAcceptance(roster, [ROAD], 0, step, seed)
    for name, habit in zip(names, habits or (HABIT,) * count, strict=True):
        gaps.meet(name, habit)
    return gaps, roster


@pytest.mark.parametrize("flow", [200.0, 400.0])
def test_delay_is_the_formula_of_the_highway_capacity_manual(flow: float) -> None:
    """With Poisson arrivals: d = (exp(v t_c) - v t_c - 1) / v (HCM 2010, equation 19-71)."""
    rate, step, random = flow / 3600.0, 0.1, np.random.default_rng(7)
    waits, formula = [], []
    for seed in range(400):
        gaps, _ = at_the_kerb(1, step=step, seed=seed)
        before, after = (np.cumsum(random.exponential(1.0 / rate, n)) for n in (2, 60))
        arrivals = np.concatenate([-before, after])
        for k in range(5000):
            seen = arrivals[np.abs(arrivals - k * step) < 20.0] - k * step
            cars = arriving(*(SPEED * seen))
            gaps.update(lambda _, cars=cars: cars)
            if not gaps.held.any():
                break
        t_c = (LENGTH + 0.4) / PACE + gaps._traits[0, 0] + 9.0 / SPEED  # and until it has left
        waits.append(k * step)
        formula.append((math.exp(rate * t_c) - rate * t_c - 1.0) / rate)
    assert np.mean(waits) == pytest.approx(np.mean(formula), rel=0.15)


def test_people_differ_and_heed_what_the_scenario_says() -> None:
    eager = HABIT._replace(margin=0.0)
    blind = HABIT._replace(ignore_probability=1.0, ignore_speed=20.0)
    waited = HABIT._replace(waited=120.0)
    gaps, _ = at_the_kerb(5, HABIT, eager, blind, waited, HABIT._replace(impatience=1.0))
    cars = arriving(SPEED * 6.0)
    gaps.update(lambda _: cars)
    assert gaps.held.tolist() == [True, False, False, False, False]
    several, _ = at_the_kerb(20)
    cars = arriving(SPEED * (LENGTH / PACE + 3.3))
    several.update(lambda _: cars)
    assert 0 < several.held.sum() < 20


def test_decision_is_taken_back_until_the_person_is_on_the_crossing() -> None:
    gaps, roster = at_the_kerb(1)
    gaps.update(lambda _: arriving())
    assert roster.crowd.waypoint_signal.tolist() == [1, -1]
    gaps.update(lambda _: arriving(20.0))
    assert roster.crowd.waypoint_signal.tolist() == [0, -1]
    assert roster.crowd.waypoint_index.tolist() == [0]
    roster.crowd.position[0, 1] = 0.5
    gaps.update(lambda _: arriving(20.0))
    assert roster.crowd.waypoint_index.tolist() == [1]
    assert not gaps.held.any()


def test_standing_car_gives_way_but_not_to_who_follows_others() -> None:
    stands = arriving(1.0, speed=0.0)
    gaps, roster = at_the_kerb(2)
    gaps.update(lambda _: stands)
    assert not gaps.held.any()
    roster.crowd.position[0, 1] = 2.0
    roster.crowd.waypoint_index[0] = 1
    gaps.update(lambda _: stands)
    assert gaps.held.tolist() == [False, True]
    for _ in range(100):  # 10 s later they go before it
        gaps.update(lambda _: stands)
    assert not gaps.held.any()
    gaps, roster = at_the_kerb(2)
    roster.crowd.position[0, 1] = 2.0
    roster.crowd.waypoint_index[0] = 1
    gaps.update(lambda _: stands._replace(yields=np.ones(1)))
    assert not gaps.held.any()
