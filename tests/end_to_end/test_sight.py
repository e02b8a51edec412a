"""Drives with cameras, past parked cars from behind which a child runs out."""

import tomllib

import numpy as np
import pytest

from giveway.results.pictures import top_view_picture
from sumo_scenarios import find


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


def school_run(run_once, file: str):
    """A drive past the school, with the children of one of the scenario's files."""
    text = (find("school_run").folder / file).read_text(encoding="utf-8")
    children = tomllib.loads(text)["crowd"]["scripted"]
    return children, run_once(**{"scenario": "school_run", "crowd.scripted": children})


@pytest.mark.parametrize(
    ("file", "slowest", "fastest"),
    [("school_run.giveway.toml", 0.0, 0.3), ("running.toml", 1.38, 1.39)],
)
def test_children_before_a_school_come_in_sight_within_the_assumption_or_beyond_it(
    run_once, file: str, slowest: float, fastest: float
) -> None:
    children, result = school_run(run_once, file)
    speeds = result.trajectories.set_index(["id", "time"]).speed
    first = result.sights.drop_duplicates("id").set_index("id").time
    for child in children:
        if child["y"] < 0.0:  # 0.3 s is the latency
            now = speeds[child["name"], round(first[child["name"]] - 0.3, 2)]
            assert slowest <= now <= fastest, child["name"]


@pytest.mark.parametrize(
    ("file", "hardest"), [("school_run.giveway.toml", 3.5), ("running.toml", 9.0)]
)
def test_children_who_cross_in_groups_before_a_school_are_spared(
    run_once, file: str, hardest: float
) -> None:
    """All ten cross; those who have walked away behind the parked cars stop nobody any more."""
    _, result = school_run(run_once, file)
    assert result.summary["completed"]
    assert result.summary["overlaps"] == 0
    assert result.summary["peak_deceleration"] < hardest
    crossed = result.trajectories.query("type == 'pedestrian'").groupby("id").y.agg(np.ptp)
    assert len(crossed) == 10
    assert (crossed > 10.5).all()


GHOSTS = {"sensor_options.false_rate": 10.0, "sensor_options.false_speed": 1.4}
WITH_CHILD = {"scenario": "parked_cars", "time_limit": 10.5, "record.near": 500.0}


@pytest.mark.parametrize("controller", ["mpc", "pid-tuned", "careful-driver", "mpc-paper"])
def test_false_detections_slow_every_controller_and_leave_the_truth_alone(
    run_once, controller: str
) -> None:
    """Ten per second and camera: people, contacts and names of people are as without them."""
    plain = run_once(**WITH_CHILD, controller=controller)
    ghosts = run_once(**WITH_CHILD, controller=controller, **GHOSTS)
    false = ghosts.sights[ghosts.sights.id.str.startswith("false:")]
    assert len(false) > 100
    assert false.id.is_unique
    assert ghosts.ego.position.iloc[-1] < plain.ego.position.iloc[-1]
    walks = [run.trajectories.query("id == 'child.1'") for run in (plain, ghosts)]
    names = ["time", "x", "y", "angle", "speed", "vx", "vy"]
    assert walks[0][names].to_csv(index=False) == walks[1][names].to_csv(index=False)
    assert set(ghosts.pedestrians.id) == {"child.1"}
    assert not ghosts.trajectories.id.str.startswith("false:").any()
    assert ghosts.summary["overlaps"] == 0


def test_false_detections_are_named_where_the_controller_expects_them(run_once) -> None:
    crowd = {"crowd.pedestrians": 5, "perception.sensor": "sight", "time_limit": 1.5}
    model = {"perception.model": "drift", "perception.desired_speeds": "typical"}
    result = run_once(**crowd, **model, **GHOSTS, **{"record.predictions": 0.5})
    expected = set(result.predictions.id)
    assert any(name.startswith("false:") for name in expected)
    assert expected <= set(result.sights.id)


def test_drives_with_false_detections_repeat_byte_for_byte(run_once) -> None:
    both = run_once(**WITH_CHILD, **GHOSTS), run_once(**WITH_CHILD, **GHOSTS, controller="mpc")
    assert len({run.ego.to_csv() for run in both}) == 1
    assert len({run.sights.to_csv() for run in both}) == 1
