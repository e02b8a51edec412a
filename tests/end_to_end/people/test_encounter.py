"""The scenario encounter: people come as the ego does, whoever drives, or nobody."""

import numpy as np
import pytest

import giveway


def starts(result: giveway.RunResult) -> dict[str, tuple[float, float]]:
    crowd = result.crowd_track
    first = crowd.step == 0
    names = [crowd.ids[i] for i in crowd.pedestrian[first]]
    return dict(zip(names, zip(crowd.x[first], crowd.y[first], strict=True), strict=True))


@pytest.fixture(scope="module")
def driven() -> giveway.RunResult:
    everywhere = {"near": 1e6, "far_period": 0.05}
    config = {"scenario": "encounter", "seed": 2, "controller": "pid-tuned", "record": everywhere}
    return giveway.run({**config, "crowd": {"pedestrians": 12}})


def test_a_crowd_slows_the_ego_and_nobody_does_not(driven) -> None:
    assert driven.summary["slowed"] is True
    assert driven.summary["completion_time"] > 16.0
    empty = {"scenario": "encounter", "controller": "pid-tuned", "crowd": {"pedestrians": 0}}
    alone = giveway.run(empty).summary
    assert alone["slowed"] is False
    assert alone["completion_time"] == pytest.approx(15.0, abs=0.5)


def test_the_same_people_walk_when_nobody_drives(driven) -> None:
    alone = giveway.run(
        {
            "scenario": "encounter",
            "seed": 2,
            "ego": {"none": True},
            "crowd": {"pedestrians": 12},
            "time_limit": 1.0,
            "record": {"near": 1e6, "far_period": 0.05},
        }
    )
    assert starts(alone) == starts(driven)
    assert len(starts(alone)) == 12
    again = giveway.run(alone.config.model_dump())  # as it is written down
    assert starts(again) == starts(alone)


def test_unknown_goals_change_the_prediction_not_the_people() -> None:
    config = {"scenario": "encounter", "seed": 2, "time_limit": 6.0, "controller": "mpc"}
    runs = [giveway.run({**config, "perception": {"goals": g}}) for g in ("known", "heading")]
    forces = [run.ego_track.force for run in runs]
    assert not np.array_equal(*forces)
    assert starts(runs[0]) == starts(runs[1])
