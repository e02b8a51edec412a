"""The front of time against people met: exact on its lattice, and met is what the metric says."""

import itertools

import clairvoyant_encroachment as encroachment
import clairvoyant_front_tables as tables
import clairvoyant_lattice
import clairvoyant_search as search
import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import giveway
from giveway.geometry.bodies import VehicleShape
from giveway.metrics import encroachment as encroachment_of
from giveway.run_data.tracks import EgoTrack

H = 0.05  # [s] of the records
BODIES = encroachment.Bodies(VehicleShape(length=5.0, width=2.0), body_radius=0.27)
COARSE = search.Limits(speed=4.0, step=0.2)  # accelerations 4 m/s^2 apart, speeds 0.8 m/s


def walking(at, offset, velocity, *, duration=20.0):
    """People on straight ways: (n,) where they are at first and (n, 2) how fast they walk."""
    t = H * np.arange(round(duration / H) + 1)[:, None]
    along, across = np.asarray(velocity, float).T
    return search.People(np.asarray(at) + along * t, np.asarray(offset) + across * t)


def clock():
    """A track that has nothing but a clock."""
    columns = dict.fromkeys(EgoTrack.__dataclass_fields__, np.zeros(2))
    return EgoTrack(**(columns | {"time": np.array([0.0, H])}))


def searched(people, *, goal=40.0, limits=None, speed=4.0, counted=None):
    """The search among people, its lattice and its stretches."""
    lattice = clairvoyant_lattice.Lattice.of(limits or search.Limits(), goal)
    every = round(lattice.step / H)
    coarse = search.People(people.station[::every], people.offset[::every])
    flags = search.flags_of(coarse, lattice, search.Rules())
    gap = encroachment.certain_gap(lattice, H)
    stretches = encroachment.stretches_of(people, lattice, BODIES, H, gap)
    if counted is None:
        counted = np.ones(people.station.shape[1], dtype=bool)
    return encroachment.Search(flags, stretches, lattice, speed, counted), lattice, stretches


def one_crossing(at=20.0, when=5.0):
    """Somebody who crosses the ego's way at 1 m/s."""
    return walking([at], [-when], [(0.0, 1.0)])


def test_nobody_about_is_full_speed_and_nobody_met():
    found, lattice, _ = searched(walking([20.0], [30.0], [(0.0, 1.0)]))
    (first, last) = found.front()
    assert first.course.time == last.course.time == pytest.approx(lattice.shortest)
    assert (first.met, last.met) == (0, 0)


def test_a_second_for_a_crossing_person_costs_as_the_metric_says():
    """Being there just when the ego is: at full speed met, a second kept by arriving later."""
    people = one_crossing()
    found, lattice, _ = searched(people)
    fast, spared = found.front()
    assert (fast.met, spared.met) == (1, 0)
    times = [
        float(encroachment.encroachments(each.course, lattice, people, BODIES, clock())[0])
        for each in (fast, spared)
    ]
    assert times[0] < 1.0
    assert 1.0 <= times[1] <= 1.0 + 2 * lattice.step + H
    # It is out of the way 1.27 s after it was on the way's middle; and a second later.
    assert spared.course.time == pytest.approx(5.0 + 1.27 + 1.0 + 20.0 / 4.0, abs=0.3)


def test_who_is_not_counted_is_not_waited_for():
    found, lattice, _ = searched(one_crossing(when=6.5), counted=np.array([False]))
    assert found.most_spared().course.time == pytest.approx(lattice.shortest)


crossing = st.tuples(
    st.floats(2.0, 38.0), st.floats(-12.0, 12.0), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)
)


@settings(max_examples=15, deadline=None)
@given(crowd=st.lists(crossing, min_size=1, max_size=6))
def test_met_is_what_the_metric_finds(crowd):
    """Who is not met is left a second by the metric; whom the metric leaves more is not met."""
    at, offset, along, across = np.array(crowd).T
    people = walking(at, offset, np.column_stack([along, across]))
    found, lattice, stretches = searched(people)
    for vertex in found.front():
        course = vertex.course
        if course.time > H * len(people.station) - 2.0:  # nobody is followed any more
            continue
        times = encroachment.encroachments(course, lattice, people, BODIES, clock())
        met = stretches.at(course.stations).any(axis=0)
        assert not np.any((times < 1.0 - 1e-9) & ~met)
        # Driving on beyond the goal is not on the track; elsewhere a gap and a step are the most.
        far = encroachment.certain_gap(lattice, H) + lattice.step
        inside = stretches.at(course.stations[:-1])[: -round(far / lattice.step)].any(axis=0)
        assert not np.any((~(times <= far)) & inside)
        exact = encroachment.stretches_of(people, lattice, BODIES, H, encroachment.SECOND)
        surely = exact.at(course.stations[:-1])[: -round(far / lattice.step)].any(axis=0)
        assert not np.any(~(times < 1.0) & surely)


def enumerated(flags, stretches, lattice, speed):
    """The least time at which so many are met, of all motions without contact, one by one."""
    best = {}
    for turns in itertools.product((-1, 0, 1), repeat=9):
        s, v, a, stations = 0, speed, 0, [0]
        for turn in turns:
            a += turn
            if not lattice.lowest <= a <= lattice.highest or not 0 <= v + a <= lattice.speeds:
                break
            before, s, v = s, s + 2 * v + a, v + a
            stations.append(s)
            if s >= lattice.stations:
                k = len(stations) - 2
                time = lattice.step * (k + (lattice.stations - before) / (s - before))
                here = stretches.at(np.array(stations))
                met = int(np.count_nonzero(here[1:] & ~here[:-1] & ~here[0]))
                best[met] = min(best.get(met, np.inf), time)
                break
            if flags[len(stations) - 1, s] & search.CONTACT:
                break
    return best


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10_000), speed=st.integers(2, 5))
def test_no_motion_is_below_the_front(seed, speed):
    lattice = clairvoyant_lattice.Lattice.of(COARSE, 4.0)
    rng = np.random.default_rng(seed)
    flags = np.zeros((10, lattice.stations), dtype=np.uint8)
    first = np.full((10, 4), 1 << 40)
    stretches = encroachment.Stretches(first, -first)
    for i in range(4):  # somebody is met at some stations for some time, moving
        k, s, v = rng.integers(0, 7), rng.integers(0, lattice.stations), rng.integers(-5, 6)
        for j in range(k, min(k + 4, 10)):
            stretches.first[j, i] = s + v * (j - k)
            stretches.last[j, i] = s + v * (j - k) + rng.integers(5, 30)
    counted = np.ones(4, dtype=bool)
    found = encroachment.Search(flags, stretches, lattice, speed * lattice.speed, counted)
    front = [(vertex.course.time, vertex.met) for vertex in found.front()]
    best = enumerated(flags, stretches, lattice, speed)
    for time, met in front:  # a vertex is a motion: if it is short enough, it is the best one
        if time <= 9 * lattice.step and met in best:
            assert time == pytest.approx(best[met], abs=1e-9)
    for price in (0.01, 0.05, 0.1, 0.2, 0.4, 1.0, 5.0):
        least = min(time + price * met for time, met in front)
        assert least <= min(time + price * met for met, time in best.items()) + 1e-9


def test_the_mean_front_is_the_best_of_all_choices():
    rng = np.random.default_rng(3)
    fronts = []
    for _ in range(4):
        points = rng.random((5, 2)) * 10.0
        fronts.append(points)
    mean = tables.mean_front(fronts)
    assert np.all(np.diff(mean[:, 0]) >= 0.0)
    assert np.all(np.diff(mean[:, 1]) < 0.0)
    choices = np.array([np.mean(c, axis=0) for c in itertools.product(*fronts)])
    for price in np.geomspace(0.01, 100.0, 30):
        least = (choices @ (1.0, price)).min()
        assert (mean @ (1.0, price)).min() == pytest.approx(least)


def rows_of(saved_times, base_time=20.0):
    """Two crowds with a baseline of 20 s and a share of 0.2, and a front of two motions."""
    rows = []
    for seed, times in enumerate(saved_times):
        rows.append(("scene", seed, tables.BASELINE, tables.DRIVEN, 10.0, base_time, 0.2, 1, 0))
        for time, share in zip(times, (0.3, 0.1), strict=True):
            rows.append(("scene", seed, "r", tables.FRONT, 10.0, time, share, 1.0, 0.0))
    columns = ["scene", "seed", "recording", "motion", "free", "time", "share", "met", "contact"]
    return pd.DataFrame(rows, columns=columns)


def test_what_can_be_saved_is_read_off_the_mean_front():
    group = tables.Group("scene", rows_of([(10.0, 14.0), (12.0, 20.0)]))
    # From 11 s at 0.3 the cheaper crowd is spared first: 13 s at 0.2.
    assert group.saved_at("r", 0.0).value == pytest.approx(0.7)
    assert group.saved_at("r", 0.1).value == pytest.approx(0.9)
    assert group.more_at("r", 0.7).value == pytest.approx(0.0)
    assert group.more_at("r", 0.9).value == pytest.approx(0.1)
    found, least = group.in_each("r")  # 14 and 20 s keep it; 12 and 16 s are between two motions
    assert group.saved(found).value == pytest.approx(0.3)
    assert group.saved(least).value == pytest.approx(0.6)


def test_the_metric_in_the_egos_coordinates_is_the_metric():
    run = giveway.run(
        {"seed": 3, "controller": "pid-tuned", "record": {"near": 1e6, "far_period": H}}
    )
    ego, track = run.egos[0], run.ego_track
    start = float(track.front_x[0]), float(track.front_y[0]), float(track.heading[0])
    people = search.people_along(ego.crowd, H, start, 60.0, H)
    lattice = clairvoyant_lattice.Lattice.of(search.Limits(), ego.goal)
    bodies = encroachment.Bodies(run.shape, run.body_radius)
    exact = encroachment.stretches_of(people, lattice, bodies, H, encroachment.SECOND)
    times = encroachment_of(track, ego.crowd, bodies.shape, bodies.body_radius).time
    at = np.round(track.position[::2] / lattice.station).astype(np.int64)
    met = exact.at(at).any(axis=0)
    assert 0 < met.sum() <= (times < 1.0).sum()
    assert not np.any(met & ~(times < 1.0 + 1e-3))
