"""What noise in perceived positions costs, with a tracker and without."""

import numpy as np
import pytest

import giveway


def drive(controller="mpc", seed=8, **perception):
    run = {"scenario": "shared_space", "seed": seed, "crowd": {"pedestrians": 30, "preset": "SIM"}}
    seen = {"preset": "SIM", **perception}
    return giveway.run(run | {"controller": controller, "perception": seen}, pictures=False)


@pytest.mark.parametrize("seed", [2, 4, 6])
def test_a_tracker_takes_most_of_it_away(seed):
    """Without one, positions that jump by 0.1 m are people who run: the ego brakes in full."""
    exact, tracked, raw = (
        drive(seed=seed, **perception).summary
        for perception in ({}, {"position_noise": 0.1}, {"position_noise": 0.1, "tracker": False})
    )
    for calm in (exact, tracked):
        assert calm["hard_brakes"] == 0
        assert calm["peak_deceleration"] < 2.0
    assert tracked["rms_jerk"] < exact["rms_jerk"] + 0.7
    assert raw["hard_brakes"] >= 1
    assert raw["peak_deceleration"] > 7.0
    assert raw["rms_jerk"] > 5.0 * tracked["rms_jerk"]


@pytest.mark.parametrize("controller", ["mpc-paper", "pid-paper"])
def test_the_papers_controllers_have_none_unless_told(controller):
    noise = {"position_noise": 0.3}
    left_out, off, on = (
        drive(controller, **noise, **t) for t in ({}, {"tracker": False}, {"tracker": True})
    )
    assert np.array_equal(left_out.ego.force, off.ego.force)
    assert not np.array_equal(left_out.ego.force, on.ego.force)
