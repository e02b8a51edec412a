"""Streams of people: who arrives when, where, and that nothing but the seed decides it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.crowd.generation.flows import Flows
from giveway.crowd.generation.groups import party_size
from giveway.crowd.roster import Roster
from giveway.crowd.ways import LitCrossing, gates_of
from pedestrian_model import OPEN_GROUND, SIM, Crowd, CrowdModel, Surroundings, Vehicles, arrived

STEP = 0.1  # [s]
WIDE = {"from": [-500.0, 0.0, 500.0, 2.0], "to": [-500.0, 40.0, 500.0, 42.0], "rate": 3600.0}
NARROW = {"from": [[0.0, 0.0], [3.0, 0.0]], "to": [0.0, 30.0, 3.0, 32.0], "rate": 1800.0}


def flows(*flow: dict[str, Any], seed: int = 1, **crowd: Any) -> tuple[Flows, Roster]:
    config = RunConfig.model_validate({"seed": seed, "crowd": {"flow": list(flow), **crowd}})
    roster = Roster()
    names = [f"{flow.name}." for flow in config.crowd.flow]
    return Flows(config, roster, names, STEP), roster


def entries(stream: Flows, until: float) -> list[tuple[int, str]]:
    """Step and name of everybody who comes in."""
    steps = range(round(until / STEP) + 1)
    return [(step, name) for step in steps for names in stream.enter(step) for name in names]


def test_they_come_at_the_rate_with_poisson_headways() -> None:
    stream, _ = flows(WIDE, minimum_spacing=0.0)
    came = np.array([step for step, _ in entries(stream, 2000.0)]) * STEP
    assert len(came) == pytest.approx(2000, abs=3 * np.sqrt(2000))  # three standard deviations
    headways = np.diff(came)
    assert headways.mean() == pytest.approx(1.0, rel=0.1)
    assert headways.std() == pytest.approx(1.0, rel=0.1)  # of an exponential one the mean
    assert np.mean(headways > 2.0) == pytest.approx(np.exp(-2.0), abs=0.03)


def test_begin_end_and_scale_hold() -> None:
    stream, _ = flows({**WIDE, "begin": 20.0, "end": 50.0}, flow_scale=2.0)
    came = np.array([step for step, _ in entries(stream, 100.0)]) * STEP
    assert came.min() >= 20.0
    assert came.max() <= 50.0 + STEP
    assert len(came) == pytest.approx(60, abs=3 * np.sqrt(60))
    assert not stream.keeps_coming


def state(roster: Roster) -> list[bytes]:
    crowd = roster.crowd
    return [array.tobytes() for array in (*crowd.state, *crowd.fixed_arrays)]


def test_arrivals_depend_on_the_seed_alone_not_on_other_flows() -> None:
    alone, roster = flows({**WIDE, "name": "a"})
    both, others = flows({**WIDE, "name": "a"}, {**NARROW, "name": "b"})
    again, same = flows({**WIDE, "name": "a"})
    other, elsewhere = flows({**WIDE, "name": "a"}, seed=2)
    first = entries(alone, 30.0)
    assert first == entries(again, 30.0)
    assert first == [entry for entry in entries(both, 30.0) if entry[1].startswith("a.")]
    assert first != entries(other, 30.0)
    assert state(roster) == state(same)
    assert state(roster) != state(elsewhere)
    mine = np.array([name.startswith("a.") for name in others.names])
    assert np.array_equal(others.crowd.position[mine], roster.crowd.position)


def test_afresh_is_the_same_from_the_beginning() -> None:
    stream, roster = flows(WIDE, groups=0.5, people={"elderly": 0.5})
    first = entries(stream, 20.0)
    copy = Roster()
    assert entries(stream.afresh(copy), 20.0) == first
    assert state(copy) == state(roster)
    assert copy.traits == roster.traits


def test_nobody_comes_twice_at_one_step() -> None:
    stream, roster = flows(WIDE)
    came = entries(stream, 20.0)
    assert stream.enter(round(20.0 / STEP)) == [[]]
    assert len(roster) == len(came)


def test_nobody_enters_on_somebody_and_the_backing_up_is_told() -> None:
    stream, roster = flows({**NARROW, "name": "tight"}, minimum_spacing=0.8)
    came = entries(stream, 60.0)  # nobody walks on
    offsets = roster.crowd.position[:, None] - roster.crowd.position[None]
    apart = np.hypot(offsets[..., 0], offsets[..., 1])[np.triu_indices(len(roster), 1)]
    assert 2 <= len(came) <= 4  # no more stand on 3 m
    assert apart.min() >= 0.8
    (remark,) = stream.remarks
    assert "flow 'tight': it backed up" in remark
    assert stream.keeps_coming  # they still wait


def test_who_waited_for_room_comes_in_when_there_is_some() -> None:
    stream, roster = flows({**NARROW, "end": 30.0}, minimum_spacing=0.8)
    model = CrowdModel(SIM, STEP)
    names = []
    for step in range(1200):
        names += stream.enter(step)[0]
        model.advance(roster.crowd, Vehicles.empty(), OPEN_GROUND)
        roster.release(arrived(roster.crowd, 0.5))
    unhindered, _ = flows({**NARROW, "end": 30.0}, minimum_spacing=0.0)
    assert names == [name for _, name in entries(unhindered, 60.0)]
    assert len(roster) == 0


def test_early_parties_start_where_they_would_have_walked_to() -> None:
    straight = {"from": [0.0, 0.0, 3.0, 2.0], "to": [0.0, 40.0, 3.0, 42.0], "rate": 3600.0}
    stream, roster = flows({**straight, "begin": -3600.0}, minimum_spacing=0.0)
    stream.enter(0)
    y = roster.crowd.position[:, 1]
    speed = roster.crowd.desired_speed
    assert len(roster) == pytest.approx(40.0 / 1.35, abs=3 * np.sqrt(30.0))  # 1 per s for 30 s
    assert y.min() >= 0.0
    assert y.max() <= 42.0
    assert np.mean(y) == pytest.approx(20.5, abs=3 * 12.0 / np.sqrt(len(y)))  # all along the way
    assert np.allclose(np.hypot(*roster.crowd.velocity.T), speed)


def test_they_walk_through_what_lies_on_the_way() -> None:
    through = {**NARROW, "to": [20.0, 0.0], "via": [[[0.0, 10.0], [3.0, 10.0]], [10.0, 12.0]]}
    stream, roster = flows(through, minimum_spacing=0.0)
    model = CrowdModel(SIM, STEP)
    crossed, corner = set(), set()
    for step in range(600):
        if step < 200:
            stream.enter(step)
        before = roster.crowd.position.copy()
        model.advance(roster.crowd, Vehicles.empty(), OPEN_GROUND)
        now = roster.crowd.position
        over = (before[:, 1] < 10.0) & (now[:, 1] >= 10.0) & (now[:, 0] > 0.0) & (now[:, 0] < 3.0)
        crossed |= set(np.array(roster.names)[over])
        corner |= set(np.array(roster.names)[np.hypot(*(now - (10.0, 12.0)).T) < 1.0])
        roster.release(arrived(roster.crowd, 0.5))
    assert len(roster) == 0
    assert len(crossed) > 3
    assert crossed == corner == set(roster.ids)


def test_early_parties_that_passed_a_gate_go_on_from_there() -> None:
    through = {**WIDE, "via": [[[-500.0, 20.0], [500.0, 20.0]]], "begin": -60.0}
    stream, roster = flows(through, minimum_spacing=0.0)
    stream.enter(0)
    ways = np.diff(roster.crowd.waypoint_start)
    beyond = roster.crowd.position[:, 1] > 20.0
    assert (ways[beyond] == 1).all()
    assert (ways[~beyond] == 2).all()
    assert 0 < beyond.sum() < len(beyond)


def test_lines_face_away_from_where_the_flow_comes_from() -> None:
    config = RunConfig.model_validate(
        {
            "crowd": {
                "flow": [{**NARROW, "via": [[[3.0, 9.0], [0.0, 9.0]], [[5.0, 9.0], [5.0, 0.0]]]}]
            }
        }
    )
    first, second = gates_of(config.crowd.flow[0])
    assert first.across == pytest.approx([0.0, 1.0])
    assert second.across == pytest.approx([1.0, 0.0])
    assert first.half_width == pytest.approx(1.5)


@pytest.mark.parametrize("back", [False, True])
def test_they_wait_at_the_kerb_until_their_light_is_green(back: bool) -> None:
    """A crossing from y = 10 to 17 m, walked over either way."""
    crossing = LitCrossing(np.array([1.5, 10.0]), np.array([0.0, 1.0]), 7.0, 2.0, 0)
    way = {**NARROW, "from": NARROW["to"], "to": NARROW["from"]} if back else NARROW
    config = RunConfig.model_validate({"crowd": {"flow": [{**way, "end": 10.0}]}})
    roster = Roster()
    stream = Flows(config, roster, ["a."], STEP, [crossing])
    model, closed = CrowdModel(SIM, STEP), np.array([True])
    for step in range(900):
        stream.enter(step)
        closed[0] = step < 500
        model.advance(roster.crowd, Vehicles.empty(), Surroundings(walls=None, closed=closed))
        roster.release(arrived(roster.crowd, 0.5))
        y = roster.crowd.position[:, 1]
        if step == 499:
            assert len(roster) >= 2
            assert (y > 17.0).all() if back else (y < 10.0).all()
            assert (np.abs(y - 13.5) < 6.0).all()  # at the kerb, nobody stayed behind
    assert len(roster) == 0


def test_a_crossing_beside_the_way_does_not_stop_anybody() -> None:
    crossing = LitCrossing(np.array([9.0, 10.0]), np.array([0.0, 1.0]), 7.0, 2.0, 0)
    assert crossing.gate(np.array([1.0, 0.0]), np.array([1.0, 30.0])) is None
    assert crossing.gate(np.array([9.0, 12.0]), np.array([9.0, 30.0])) is None  # starts on it
    assert crossing.gate(np.array([9.0, 0.0]), np.array([9.0, 12.0])) is None  # ends on it
    assert crossing.gate(np.array([9.0, 0.0]), np.array([9.0, 30.0])) is not None


def test_groups_come_together_at_the_rate_of_persons() -> None:
    stream, roster = flows(WIDE, groups=0.7, minimum_spacing=0.0)
    entries(stream, 3000.0)
    assert len(roster.ids) == pytest.approx(3000, abs=3 * np.sqrt(2 * 3000))  # they are clustered
    grouped = [roster.traits[name].group for name in roster.ids if name in roster.traits]
    assert len(grouped) / len(roster.ids) == pytest.approx(0.7, abs=0.05)
    first = grouped[0]
    own = {name for name, trait in roster.traits.items() if trait.group == first}
    rows = [i for i, name in enumerate(roster.names) if name in own]
    assert len(rows) >= 2
    assert np.ptp(roster.crowd.desired_speed[rows]) == 0.0
    spread = roster.crowd.position[rows] - roster.crowd.position[rows].mean(axis=0)
    assert np.hypot(*spread.T).max() < 1.5


def test_nothing_is_drawn_where_nobody_walks_in_groups() -> None:
    random = np.random.default_rng(1)
    assert party_size(0.0, random) == 1
    assert random.random() == np.random.default_rng(1).random()


def test_the_ledger_counts_them_as_added() -> None:
    stream, roster = flows(WIDE)
    came = entries(stream, 20.0)
    assert roster.ledger["added"] == roster.ledger["walking"] == len(came)
    roster.take_in(["ann"], Crowd.create([(0, 0)], [(0, 0)], 1.0, [[(1, 1)]]))
    assert roster.ledger["taken_over"] == 1
    assert "ann" not in roster.added


def test_an_old_flow_is_drawn_from_the_slowest_possible_walk_on() -> None:
    """Nobody who came 90 s ago is still on a way of 45 m at 0.5 m/s or more."""
    way = {"from": [0.0, 0.0, 3.0, 2.0], "to": [0.0, 40.0, 3.0, 42.0], "rate": 50_000.0}
    streams = [flows({**way, "begin": begin}, minimum_spacing=0.0) for begin in (-90.0, -3600.0)]
    for stream, _ in streams:
        stream.enter(0)
    assert state(streams[0][1]) == state(streams[1][1])
