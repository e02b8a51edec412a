"""At the lane's speed past people who stay on the sidewalk: no hard braking for them."""

import numpy as np
import pytest

import giveway

HARD = 3.0  # m/s^2


def drive(seed, **changes):
    """The first 18 s of a drive through ``crossings``: past the sidewalk before the signals.

    It is told nothing of them, so that it does not slow down for the next green. People of SIM walk
    close to the kerb beside cars.
    """
    run = {"scenario": "crossings", "seed": seed, "time_limit": 18.0, "crowd.preset": "SIM"}
    return giveway.run(run | {"rules.signal_plans": False} | changes)


def beside_the_sidewalk(result):
    """The crowd's records of those less than 1.3 m from the kerb beside whom the ego is."""
    ego, crowd = result.egos[0].track, result.egos[0].crowd
    beside = np.abs(crowd.x - ego.front_x[crowd.step]) < 2.0
    return beside & (crowd.y < -3.6) & (crowd.y > -4.8) & (crowd.x > -55.0) & (crowd.x < -12.0)


def passed_on_the_sidewalk(result):
    """How many people beside it the ego has passed at 5 m/s or more."""
    ego, crowd = result.egos[0].track, result.egos[0].crowd
    fast = ego.speed[crowd.step] > 5.0
    return len(set(crowd.pedestrian[fast & beside_the_sidewalk(result)].tolist()))


@pytest.mark.parametrize("seed", [6, 23])
def test_people_on_the_sidewalk_are_passed_without_hard_braking(seed):
    result = drive(seed)
    assert passed_on_the_sidewalk(result) >= 2
    assert result.summary["peak_deceleration"] < HARD
    assert result.summary["frontal_contacts"] == 0
    assert result.summary["safety_share"] == 0.0


def test_the_worst_case_knows_no_sidewalk():
    """There everybody may lunge at the ego from wherever they are: it passes them slowly."""
    known, unknown = drive(6), drive(6, **{"safety.people": "worst-case"})
    slowest = [
        result.egos[0].track.speed[result.egos[0].crowd.step[beside_the_sidewalk(result)]].min()
        for result in (known, unknown)
    ]
    assert slowest[1] < 5.0 < 6.0 < slowest[0]


def test_who_sets_out_more_suddenly_than_assumed_is_counted():
    result = drive(15)
    beyond = result.summary["beyond_assumption"]
    hasty = set(result.egos[0].hasty.tolist())
    harder = set(np.flatnonzero(result.pedestrians["peak_acceleration"] > 3.0 * (1.0 + 1e-6)))
    assert hasty
    assert beyond == len(hasty | harder)
