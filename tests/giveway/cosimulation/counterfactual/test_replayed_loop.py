"""The replayed loop: an ego that drives as it did, and delays of traffic."""

from __future__ import annotations

import numpy as np

OPEN = {"controller": "pid-tuned", "crowd": {"pedestrians": 10}, "seed": 3}


STREET = {"scenario": "street", "controller": "pid-tuned", "crowd": {"pedestrians": 10}}


def test_an_ego_that_blocks_a_street_delays_its_traffic(run_once):
    summary = run_once(twin=True, **STREET).summary
    assert summary["traffic_delay"] != 0.0
    assert np.isfinite(summary["traffic_delay"])
    assert np.isnan(run_once(twin=True, **OPEN).summary["traffic_delay"])
