"""What noise in perceived positions costs, with a tracker and without."""

import numpy as np
import pandas as pd
import pytest

import giveway


def drive(controller="mpc", seed=8, **perception):
    run = {"scenario": "shared_space", "seed": seed, "crowd": {"pedestrians": 30, "preset": "SIM"}}
    seen = {"preset": "SIM", **perception}
    return giveway.run(run | {"controller": controller, "perception": seen}, pictures=False)


def test_a_tracker_takes_most_of_it_away():
    """Without one, positions that jump by 0.1 m are people who run: the ego brakes in full."""
    exact, tracked, raw = (
        pd.DataFrame([drive(seed=seed, **perception).summary for seed in (2, 4, 10, 12)])
        for perception in ({}, {"position_noise": 0.1}, {"position_noise": 0.1, "tracker": False})
    )
    for calm in (exact, tracked):
        assert not calm["hard_brakes"].any()
        assert calm["peak_deceleration"].max() < 2.5
    assert tracked["rms_jerk"].mean() < 1.5 * exact["rms_jerk"].mean()
    assert raw["hard_brakes"].sum() >= 4
    assert raw["peak_deceleration"].median() > 7.0
    assert raw["rms_jerk"].mean() > 5.0 * tracked["rms_jerk"].mean()


@pytest.mark.parametrize("controller", ["mpc-paper", "pid-paper"])
def test_the_papers_controllers_have_none_unless_told(controller):
    noise = {"position_noise": 0.3}
    left_out, off, on = (
        drive(controller, **noise, **t) for t in ({}, {"tracker": False}, {"tracker": True})
    )
    assert np.array_equal(left_out.ego.force, off.ego.force)
    assert not np.array_equal(left_out.ego.force, on.ego.force)
