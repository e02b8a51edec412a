"""Predictors that a model is compared with."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from giveway.validation.predictors import straight_to

DT = 1 / 29.97


@given(
    position=st.tuples(*[st.floats(-50, 50)] * 2),
    goal=st.tuples(*[st.floats(-50, 50)] * 2),
    velocity=st.tuples(*[st.floats(-3, 3)] * 2),
)
def test_goal_cv_never_overshoots_and_keeps_its_speed(position, goal, velocity) -> None:
    x, p, v = (np.array([each]) for each in (position, goal, velocity))
    track = np.concatenate([x[None], straight_to(x, v, p, DT, 60)])[:, 0]
    left = np.hypot(*(track - p).T)
    assert (np.diff(left) <= 1e-9).all()
    assert (np.hypot(*np.diff(track, axis=0).T) <= np.hypot(*velocity) * DT + 1e-9).all()
