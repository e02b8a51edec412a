"""At the lane's speed past people who stay on the sidewalk: no hard braking for them."""

import numpy as np
import pytest

import giveway

HARD = 3.0  # m/s^2


def drive(seed, **changes):
    """The first 18 s of a drive through ``crossings``: past the sidewalk before the signals."""
    return giveway.run({"scenario": "crossings", "seed": seed, "time_limit": 18.0} | changes)


def passed_on_the_sidewalk(result):
    """How many people, less than 1.3 m from the kerb, the ego has passed at 5 m/s or more."""
    ego, crowd = result.egos[0].track, result.egos[0].crowd
    fast = ego.speed[crowd.step] > 5.0
    beside = np.abs(crowd.x - ego.front_x[crowd.step]) < 2.0
    on_it = (crowd.y < -3.6) & (crowd.y > -4.8) & (crowd.x > -55.0) & (crowd.x < -12.0)
    return len(set(crowd.pedestrian[fast & beside & on_it].tolist()))


@pytest.mark.parametrize("seed", [9, 15])
def test_who_stays_on_the_sidewalk_is_passed_without_hard_braking(seed):
    result = drive(seed)
    assert passed_on_the_sidewalk(result) >= 2
    assert result.summary["peak_deceleration"] < HARD
    assert result.summary["frontal_contacts"] == 0
    assert result.summary["safety_share"] == 0.0


def test_the_worst_case_knows_no_sidewalk():
    """There everybody may lunge at the ego from wherever they are."""
    assert drive(15, **{"safety.people": "worst-case"}).summary["peak_deceleration"] > HARD


def test_who_sets_out_more_suddenly_than_assumed_is_counted():
    result = drive(15)
    beyond = result.summary["beyond_assumption"]
    hasty = set(result.egos[0].hasty.tolist())
    harder = set(np.flatnonzero(result.pedestrians["peak_acceleration"] > 3.0 * (1.0 + 1e-6)))
    assert hasty
    assert beyond == len(hasty | harder)
