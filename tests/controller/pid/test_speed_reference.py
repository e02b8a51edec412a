"""Speed references of the tuned PID: braking curves and their parameters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller import (
    ParameterError,
    ReferenceParameters,
    TunedPid,
    TunedPidParameters,
)
from controller.pid.speed_reference import SpeedReference, stoppable

DT = 0.05  # [s]


PROFILES = ("braking-curve", "linear")


def jerk(speeds):
    return np.diff(speeds, 2) / DT**2


@pytest.mark.parametrize("profile", PROFILES)
@given(gaps=st.tuples(st.floats(-5.0, 100.0), st.floats(-5.0, 100.0)), limit=st.floats(0.0, 9.0))
def test_the_profile_never_falls_with_the_gap_or_passes_limits(profile, gaps, limit):
    pid = TunedPid(TunedPidParameters(reference=ReferenceParameters(profile=profile)))
    near, far = (pid.reference_speed(gap, limit) for gap in (min(gaps), max(gaps)))
    assert 0.0 <= near <= far <= min(4.0, limit)
    assert pid.reference_speed(8.0) == 0.0
    assert pid.reference_speed(math.inf) == 4.0


@given(room=st.floats(0.0, 1e3), rate=st.floats(0.1, 10.0), lag=st.floats(0.05, 2.0))
def test_gipps_speed_stops_within_the_room(room, rate, lag):
    v = stoppable(room, rate, lag)
    assert v * lag + v * v / (2.0 * rate) == pytest.approx(room, rel=1e-6, abs=1e-9)


def test_a_reference_almost_at_rest_stops_in_one_step():
    reference = SpeedReference(ReferenceParameters(), strongest=4.0, sharpest=8.0, time_step=DT)
    reference.start(0.004)
    now, acceleration = reference.advance(0.004, gap=1.0, limit=math.inf)
    assert now == 0.004
    assert acceleration == pytest.approx(-0.004 / DT)
    assert reference.speed == 0.0


@pytest.mark.parametrize(
    ("name", "value"),
    [("deceleration", 0.0), ("approach_lag", math.nan), ("jerk", math.inf), ("profile", "cubic")],
)
def test_refuses_senseless_references(name, value):
    with pytest.raises(ParameterError, match=f"{name} = {value}: expected"):
        ReferenceParameters(**{name: value})
