"""Stopping distances and reachable sets of the safety layer."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.kernels import towards_kerb
from controller.safety.worst_motion import RECORDED

WORST = RECORDED["recorded-99.9"]


@given(
    pace=st.floats(-2.0, 2.0),
    depth=st.floats(0.01, 3.0),
    first=st.floats(0.0, 2.0),
    rest=st.floats(0.0, 2.0),
)
def test_the_later_reachable_set_lies_in_the_earlier_one(pace, depth, first, rest):
    """Why it stays safe: the next reachable sets lie in the present ones."""
    limits = WORST.setting_out, WORST.acceleration
    now = towards_kerb(first + rest, pace, depth, *limits)
    gone = towards_kerb(first, pace, depth, *limits)
    if gone < depth:
        then = pace + WORST.setting_out * first
        later = gone + towards_kerb(rest, then, depth - gone, *limits)
        assert later == pytest.approx(now, abs=1e-6)
