"""What egos cost people, from walks made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.metrics import delays, gave_way, summarise_delays
from giveway.run_data.walks import WalkTrack

STEP = 0.5  # [s]
WAY = 10.0  # [m] of everybody's route


def walked(*people: tuple[str, list[float], int | None], near: bool = True) -> WalkTrack:
    """Each: name, metres walked at the instants 0, 1, ..., and the instant of arrival or None."""
    rows = sorted(
        (step, person, metres)
        for person, (_, distances, _) in enumerate(people)
        for step, metres in enumerate(distances)
    )
    step, person, metres = (np.array(column) for column in zip(*rows, strict=True))
    metres = metres.astype(float)
    arrivals = sorted((at, i) for i, (_, _, at) in enumerate(people) if at is not None)
    nothing = np.zeros(len(step))
    return WalkTrack(
        step=step,
        pedestrian=person,
        x=metres,
        y=nothing,
        vx=nothing,
        vy=nothing,
        remaining=WAY - metres,
        walked=metres,
        arrival_step=np.array([at for at, _ in arrivals], dtype=np.int64),
        arrival_pedestrian=np.array([i for _, i in arrivals], dtype=np.int64),
        desired_speed=np.full(len(people), 2.0),
        near=np.full(len(people), near),
        ids=tuple(name for name, _, _ in people),
        time_step=STEP,
        last=int(step.max()),
    )


def test_who_arrives_in_both_has_the_difference_of_the_instants():
    run = walked(("a", [0, 3, 3, 3, 6, 9], 6))
    twin = walked(("a", [0, 3, 6, 9], 4))
    found = delays(run, twin)
    assert found.delay.tolist() == [2 * STEP]
    assert found.basis.tolist() == ["arrival"]
    assert found.detour.tolist() == [0.0]


def test_other_delays_are_the_rest_of_way_over_desired_speed():
    run = walked(("a", [0, 1, 2, 3, 4], None))
    twin = walked(("a", [0, 2, 4, 7], 4))
    found = delays(run, twin)
    assert found.delay.tolist() == [(7 - 3) / 2.0]
    assert found.basis.tolist() == ["route"]


def test_a_longer_way_is_a_detour():
    run, twin = walked(("a", [0, 4, 9], 3)), walked(("a", [0, 4, 9], 3))
    longer = replace(run, walked=run.walked + np.array([0.0, 0.5, 1.5]))
    assert delays(longer, twin).detour.tolist() == [1.5]


def test_people_are_found_by_name_and_far_ones_do_not_count():
    run = walked(("a", [0, 9], 2), ("b", [0, 3, 6, 9], 4))
    twin = walked(("b", [0, 4, 9], 3), ("a", [0, 9], 2))
    assert delays(run, twin).delay.tolist() == [0.0, STEP]
    far = replace(run, near=np.array([False, True]))
    assert np.isnan(delays(far, twin).delay[0])
    assert delays(far, twin).basis.tolist() == ["", "arrival"]


def test_who_is_missing_in_the_twin_has_no_delay():
    found = delays(walked(("a", [0, 9], 2)), walked(("b", [0, 9], 2)))
    assert np.isnan(found.delay).all()
    assert np.isnan(found.detour).all()


def test_of_several_walks_the_last_that_both_finished_counts():
    run, twin = walked(("a", [0, 3, 6], 3)), walked(("a", [0, 5, 9], 3))
    again = {"arrival_step": np.array([3, 9]), "arrival_pedestrian": np.array([0, 0])}
    assert delays(replace(run, **again), replace(twin, arrival_step=np.array([2]))).delay == [STEP]


def test_different_time_steps_are_refused():
    run = walked(("a", [0, 9], 2))
    with pytest.raises(ValueError, match="expected the same"):
        delays(run, replace(run, time_step=0.1))


def test_who_gives_way_lets_the_ego_go_first_and_would_not_have():
    run = np.array(["ego", "ego", "ego", "person", "", "ego"])
    twin = np.array(["person", "contact", "ego", "person", "person", "person"])
    crossed = np.array([True, True, True, True, True, False])
    assert gave_way(run, twin, crossed).tolist() == ["yes", "yes", "no", "no", "", ""]


def test_the_row_of_a_run_is_that_of_its_people():
    delay = np.array([0.0, 1.0, np.nan, 4.0, -1.0])
    yielded = np.array(["no", "yes", "", "yes", "no"])
    row = summarise_delays(delay, yielded, differs=False, traffic=7.0)
    assert row.people_delayed == 4
    assert row.people_delay == 4.0
    assert row.mean_people_delay == 1.0
    assert row.people_delay_95 == pytest.approx(3.55)
    assert row.worst_people_delay == 4.0
    assert row.share_gave_way == 0.5
    assert row.traffic_delay == 7.0


def test_without_anybody_there_are_no_means():
    row = summarise_delays(np.full(2, np.nan), np.array(["", ""]), differs=False, traffic=np.nan)
    assert row.people_delayed == 0
    assert row.people_delay == 0.0
    assert np.isnan([row.mean_people_delay, row.worst_people_delay, row.share_gave_way]).all()
