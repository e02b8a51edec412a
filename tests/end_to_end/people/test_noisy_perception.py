"""What noise in perceived positions costs, with a tracker and without."""

import numpy as np
import pytest

import giveway


def drive(controller="mpc", seed=8, **perception):
    run = {"scenario": "shared_space", "seed": seed, "crowd": {"pedestrians": 30, "preset": "SIM"}}
    seen = {"preset": "SIM", **perception}
    return giveway.run(run | {"controller": controller, "perception": seen}, pictures=False)


def test_a_tracker_takes_most_of_it_away():
    exact, tracked, raw = (
        drive(seed=1, **perception).summary["rms_jerk"]
        for perception in ({}, {"position_noise": 0.1}, {"position_noise": 0.1, "tracker": False})
    )
    assert tracked < exact + 0.5
    assert raw > exact + 2.0


@pytest.mark.parametrize("controller", ["mpc-paper", "pid-paper"])
def test_the_papers_controllers_have_none_unless_told(controller):
    noise = {"position_noise": 0.3}
    left_out, off, on = (
        drive(controller, **noise, **t) for t in ({}, {"tracker": False}, {"tracker": True})
    )
    assert np.array_equal(left_out.ego.force, off.ego.force)
    assert not np.array_equal(left_out.ego.force, on.ego.force)
