"""The search for the fastest motion: exact on its lattice, and it minds what it must."""

import functools
import importlib.util
import itertools
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

FILE = Path(__file__).parents[3] / "benchmarks" / "bounds" / "clairvoyant_search.py"
SPEC = importlib.util.spec_from_file_location("clairvoyant_search", FILE)
search = importlib.util.module_from_spec(SPEC)
sys.modules["clairvoyant_search"] = search
SPEC.loader.exec_module(search)

LIMITS = search.Limits(speed=4.0, step=0.2)  # accelerations 4 m/s^2 apart, speeds 0.8 m/s
KEEP = 1e3  # [s/s] keeps d_safe wherever it can be kept
TOUCH = 1e-3  # [s/s] only contact counts


def standing(at, begin, end, *, step=0.1, duration=30.0):
    """One person on the way at ``at`` [m] from ``begin`` to ``end`` [s]."""
    instants = round(duration / step) + 1
    station, offset = np.full((instants, 1), np.nan), np.zeros((instants, 1))
    station[round(begin / step) : round(end / step)] = at
    return search.People(station, offset)


def motion(people, price, *, goal=40.0, limits=None, rules=None, speed=4.0):
    lattice = search.Lattice.of(limits or search.Limits(), goal)
    flags = search.flags_of(people, lattice, rules or search.Rules())
    return search.fastest(flags, lattice, speed, price)


@functools.cache
def past_who_leaves(price):
    """Somebody stands at 20 m until 15 s."""
    return motion(standing(20.0, 0.0, 15.0), price)


def test_nobody_in_the_way_is_full_speed_all_the_way():
    found = motion(standing(20.0, 5.0, 5.0), TOUCH)
    assert found.completion_time == pytest.approx(10.0, abs=1e-5)
    assert (found.time_below, found.contact_time) == (0.0, 0.0)


def test_from_a_standstill_driving_off_costs_what_the_limits_say():
    # 0.1, 0.2, 0.3 s at 2, 4, 6 m/s^2 ... up to 4 m/s: on this lattice 0.44 s are lost.
    found = motion(standing(20.0, 5.0, 5.0), TOUCH, speed=0.0)
    assert found.completion_time == pytest.approx(10.44, abs=1e-4)


def test_a_known_departure_is_met_at_full_speed_just_in_time():
    # The front is R short of 20 m just before, 20.27 m before the goal.
    found = past_who_leaves(TOUCH)
    assert found.completion_time == pytest.approx(15.0 - 0.1 + 20.27 / 4.0, abs=0.02)
    assert found.contact_time == 0.0


def test_keeping_d_safe_costs_the_way_that_is_kept():
    near, far = past_who_leaves(TOUCH), past_who_leaves(KEEP)
    assert far.time_below == 0.0
    assert near.time_below == pytest.approx((8.0 - 0.27) / 4.0, abs=0.11)
    assert far.completion_time - near.completion_time == pytest.approx((8.0 - 0.27) / 4, abs=0.02)


def test_somebody_who_steps_right_in_front_cannot_be_spared():
    found = motion(standing(0.5, 0.0, 3.0), TOUCH)
    assert found.contact_time > 0.0


def test_somebody_beside_the_corridor_is_not_in_front():
    people = standing(20.0, 0.0, 15.0)
    people.offset[:] = 1.3
    assert motion(people, KEEP).completion_time == pytest.approx(10.0, abs=1e-5)


def enumerated(flags, lattice, speed, price):
    """The least price of all motions, one by one."""
    best = np.inf
    for turns in itertools.product((-1, 0, 1), repeat=9):
        s, v, a, cost, k = 0, speed, 0, 0.0, 0
        for turn in turns:
            a, k = a + turn, k + 1
            if not lattice.lowest <= a <= lattice.highest or not 0 <= v + a <= lattice.speeds:
                break
            before, s, v = s, s + 2 * v + a, v + a
            if s >= lattice.stations:
                cost += lattice.step * (lattice.stations - before) / (s - before)
                best = min(best, cost)
                break
            flag = flags[k, s]
            cost += lattice.step * (1.0 + price * bool(flag & search.BELOW))
            cost += lattice.step * search.CONTACT_PRICE * bool(flag & search.CONTACT)
    return best


@settings(max_examples=15)
@given(
    seed=st.integers(0, 10_000),
    price=st.sampled_from([TOUCH, 0.5, KEEP]),
    speed=st.integers(2, 5),
)
def test_no_motion_is_better(seed, price, speed):
    lattice = search.Lattice.of(LIMITS, 4.0)
    rng = np.random.default_rng(seed)
    flags = np.zeros((10, lattice.stations), dtype=np.uint8)
    for _ in range(2):  # somebody at some station for some time
        k, s = rng.integers(0, 7), rng.integers(0, lattice.stations)
        flags[k : k + 3, s : s + 12] |= np.uint8(rng.integers(1, 4))
    found = search.fastest(flags, lattice, speed * lattice.speed, price)
    cost = found.completion_time + price * (
        found.time_below - lattice.step * float(flags[0, 0] & search.BELOW > 0)
    )
    cost += search.CONTACT_PRICE * found.contact_time
    least = enumerated(flags, lattice, speed, price)
    assert cost <= least * (1 + 1e-6) + 1e-4
    if found.completion_time <= 9 * lattice.step:  # within what is enumerated
        assert cost == pytest.approx(least, rel=1e-6, abs=1e-4)


@settings(max_examples=10)
@given(at=st.floats(3.0, 38.0), begin=st.floats(0.0, 9.0), stay=st.floats(0.0, 6.0))
def test_a_dearer_safe_distance_is_never_faster_nor_longer_below(at, begin, stay):
    people = standing(at, begin, begin + stay)
    coarse = people.station[::2], people.offset[::2]
    people = search.People(*coarse)
    found = [motion(people, price, limits=LIMITS) for price in (TOUCH, 1.0, KEEP)]
    for cheap, dear in itertools.pairwise(found):
        if cheap.contact_time == dear.contact_time == 0.0:
            assert dear.completion_time >= cheap.completion_time - 1e-3
            assert dear.time_below <= cheap.time_below + 1e-3
