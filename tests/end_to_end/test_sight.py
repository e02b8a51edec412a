"""Drives with cameras, past parked cars from behind which a child runs out."""

import pytest

from giveway.results.pictures import top_view_picture


def frontal(result) -> int:
    return int(result.summary["frontal_contacts"])


def test_the_child_is_first_seen_where_it_comes_out_from_behind_the_car(run_once) -> None:
    result = run_once(scenario="parked_cars")
    first, rows = result.sights.iloc[0], result.trajectories
    child = rows[(rows.id == first.id) & ((rows.time - first.time).abs() < 1e-6)].iloc[0]
    assert -4.8 < child.y < -3.0  # between the parked cars, whose sides are at y = -3.7 m
    assert frontal(result) == 0


def test_without_caution_the_ego_drives_past_as_fast_as_it_may(run_once) -> None:
    careful = run_once(scenario="parked_cars")
    hasty = run_once(**{"scenario": "parked_cars", "safety.hidden_speed": 0.0})
    past = [run.ego.query("50 < x < 80").speed.median() for run in (careful, hasty)]
    assert past[1] == pytest.approx(8.33, abs=0.05)
    assert 3.0 < past[0] < 6.5


def test_where_nothing_hides_anybody_cameras_change_nothing(run_once) -> None:
    """The street has no obstacles beside moving cars: the drive stays as it is."""
    run = {"scenario": "street", "time_limit": 12.0}
    everybody = run_once(**run)
    cameras = run_once(**run, **{"perception.sensor": "sight"})
    assert cameras.ego.position.iloc[-1] == pytest.approx(everybody.ego.position.iloc[-1], abs=0.5)
    assert len(cameras.sights)
    assert not (cameras.ego.reason == "hidden people").any()


def test_a_run_in_which_nothing_hides_anybody_says_so(run_once) -> None:
    sees = {"perception.sensor": "sight", "time_limit": 0.5}
    assert any("nothing hides anybody" in said for said in run_once(**sees).remarks)
    behind_cars = run_once(scenario="parked_cars", time_limit=0.5)
    assert not any("nothing hides" in said for said in behind_cars.remarks)


def test_trajectories_of_cameras_that_have_met_nobody_yet_tell_of_nobody(run_once) -> None:
    result = run_once(scenario="parked_cars", time_limit=0.5)
    assert result.trajectories["seen"].isna().all()
    assert top_view_picture(result, result.egos[0]).axes
