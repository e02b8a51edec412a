"""The follow-up: people are followed until they have arrived."""

from __future__ import annotations

import giveway

OPEN = {"controller": "pid-tuned", "crowd": {"pedestrians": 10}, "seed": 3}


def test_who_watches_is_told_what_comes_after_the_drive():
    told = []
    giveway.run({**OPEN, "twin": True, "time_limit": 2.0}, watcher=lambda p: told.append(p.doing))
    after = [doing for doing in told if doing]
    assert len(after) == 2
    assert after[0].startswith("People go on")
    assert after[1].startswith("Twin: the same again")
    assert told[-2:] == after  # once each, when the drive is over


def test_people_are_followed_until_they_have_arrived_themselves(run_once):
    result = run_once(twin=True, **OPEN)
    run = result.effect.run
    arrival = len(result.time) - 1
    assert run.last > arrival
    assert len(run.arrival_step) == 10
    assert run.last == run.arrival_step[-1] <= arrival + 60.0 / run.time_step
    assert result.trajectories["time"].max() == result.time[-1]


def test_people_who_do_not_arrive_are_compared_by_distance_left(run_once):
    result = run_once(twin=True, **(OPEN | {"time_limit": 8.0}))
    assert set(result.pedestrians["delay_by"]) == {"route"}
    assert result.effect.run.last == result.effect.twin.last == len(result.time) - 1
