"""The PID against the analytic recursion of its closed loop, and the paper's numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from controller import (
    PRINTED_PID,
    LongitudinalModel,
    ParameterError,
    Pid,
    PidParameters,
)

MODEL = LongitudinalModel()


def drive(pid, speed, steps, gap=math.inf):
    """(steps + 1,) speeds of the car under the PID."""
    speeds = [speed]
    for _ in range(steps):
        u = pid.control(speed, gap)
        speed = MODEL.decay * speed + MODEL.speed_per_force * u
        speeds.append(speed)
    return np.array(speeds)


@given(
    K_p=st.floats(0.0, 4000.0),
    K_i=st.floats(0.0, 300.0),
    K_d=st.floats(0.0, 300.0),
    speed=st.floats(0.0, 6.0),
    gap=st.floats(8.0, 30.0),
)
def test_closed_loop_is_the_analytic_recursion(K_p, K_i, K_d, speed, gap):
    """With z = [e(k), e(k-1), u_i(k-1), 1], z(k+1) = T z(k): the speed is a matrix power."""
    alpha, M, dt = MODEL.friction, MODEL.mass, MODEL.time_step
    v_r = 4.0 * min((gap - 8.0) / 10.0, 1.0)
    pid = Pid(PidParameters(K_p, K_i, K_d), dt)
    total = K_p + K_i * dt + K_d / dt
    T = np.array(
        [
            [1 - alpha * dt / M - dt / M * total, K_d / M, -dt / M, -alpha * dt / M * v_r],
            [1.0, 0.0, 0.0, 0.0],
            [K_i * dt, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    z = np.array([speed - v_r, speed - v_r, 0.0, 1.0])
    expected = [speed]
    for _ in range(60):
        u = -(total * z[0] - K_d / dt * z[1] + z[2])
        assume(abs(u) < 8000.0)  # beyond, the clip makes it another loop
        z = T @ z
        expected.append(z[0] + v_r)
    np.testing.assert_allclose(drive(pid, speed, 60, gap), expected, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize(
    ("parameters", "errors"),
    [(PRINTED_PID, (0.81, 0.86, 0.68)), (PidParameters(), (0.157, 0.154, 0.148))],
)
def test_errors_after_5_10_and_20_s_from_the_reference_speed(parameters, errors):
    speeds = drive(Pid(parameters), 4.0, 400)
    digits = 0.005 if parameters is PRINTED_PID else 0.0005
    assert 4.0 - speeds[[100, 200, 400]] == pytest.approx(errors, abs=digits)


def test_40_m_take_10_39_s_with_the_consistent_gain():
    positions = np.cumsum(drive(Pid(), 4.0, 300)) * MODEL.time_step
    k = int(np.argmax(positions >= 40.0))  # positions[k] is x_1(k+1)
    time = MODEL.time_step * (k + (40.0 - positions[k - 1]) / (positions[k] - positions[k - 1]))
    assert time == pytest.approx(10.39, abs=0.01)


@given(K_p=st.floats(100.0, 10000.0), v_r=st.floats(0.5, 15.0))
def test_without_integrator_an_error_remains(K_p, v_r):
    """alpha v_r / (K_p + alpha): the 0.16 m/s that the paper reports need K_p = 2400."""
    pid = Pid(PidParameters(K_p=K_p, K_i=0.0, K_d=0.0, reference_speed=v_r))
    assert v_r - drive(pid, v_r, 4000)[-1] == pytest.approx(100.0 * v_r / (K_p + 100.0), rel=1e-6)


@pytest.mark.parametrize(("K_p", "error"), [(PRINTED_PID.K_p, 1.0), (PidParameters().K_p, 0.16)])
def test_that_error_for_the_two_presets(K_p, error):
    speed = drive(Pid(PidParameters(K_p=K_p, K_i=0.0)), 4.0, 1000)[-1]
    assert 4.0 - speed == pytest.approx(error, abs=1e-6)


def test_the_integrator_removes_the_error_in_the_end():
    assert drive(Pid(PidParameters(K_i=200.0)), 4.0, 4000)[-1] == pytest.approx(4.0, abs=1e-4)


@pytest.mark.parametrize(
    ("gap", "expected"),
    [(-1.0, 0.0), (0.0, 0.0), (8.0, 0.0), (10.5, 1.0), (13.0, 2.0), (18.0, 4.0), (math.inf, 4.0)],
)
def test_reference_speed_of_the_buffer_distance(gap, expected):
    assert Pid().reference_speed(gap) == pytest.approx(expected, abs=1e-15)


@given(gaps=st.tuples(st.floats(-5.0, 100.0), st.floats(-5.0, 100.0)))
def test_reference_speed_never_falls_with_the_gap(gaps):
    pid = Pid()
    assert pid.reference_speed(min(gaps)) <= pid.reference_speed(max(gaps))


@given(
    steps=st.lists(st.tuples(st.floats(0.0, 20.0), st.floats(0.0, 50.0)), min_size=1, max_size=30)
)
def test_the_force_stays_within_its_limit(steps):
    pid = Pid()
    assert all(abs(pid.control(speed, gap)) <= 8000.0 for speed, gap in steps)


def test_each_part_by_hand():
    pid = Pid(PidParameters(K_p=100.0, K_i=10.0, K_d=1.0), 0.05)
    # e = 1: u_p = 100, u_i = 10 * 1 * 0.05, u_d = 0: there was no error before
    assert pid.control(5.0, math.inf) == pytest.approx(-(100.0 + 0.5))
    # e = 3: u_p = 300, u_i = 0.5 + 10 * 3 * 0.05, u_d = (3 - 1) / 0.05
    assert pid.control(7.0, math.inf) == pytest.approx(-(300.0 + 2.0 + 40.0))


def test_while_another_acts_it_keeps_the_error_but_no_integral():
    pid = Pid(PidParameters(K_p=100.0, K_i=10.0, K_d=1.0), 0.05)
    for _ in range(50):
        pid.control(9.0, math.inf)
    pid.track(5.0, math.inf)
    # e = 2 after 1: u_p = 200, u_i = 10 * 2 * 0.05, u_d = (2 - 1) / 0.05
    assert pid.control(6.0, math.inf) == pytest.approx(-(200.0 + 1.0 + 20.0))


def test_reset_forgets_all():
    pid = Pid()
    first = [pid.control(speed, 12.0) for speed in (3.0, 2.0, 4.0)]
    pid.reset()
    assert [pid.control(speed, 12.0) for speed in (3.0, 2.0, 4.0)] == first


@pytest.mark.parametrize(("speed", "gap"), [(math.nan, 10.0), (4.0, math.nan), (math.inf, 10.0)])
def test_refuses_what_is_no_number(speed, gap):
    with pytest.raises(ParameterError, match=r"speed = .* m/s, gap = .* m: expected numbers"):
        Pid().control(speed, gap)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("K_p", -1.0),
        ("K_i", math.nan),
        ("K_d", math.inf),
        ("reference_speed", 0.0),
        ("safe_distance", -0.1),
        ("buffer_distance", 0.0),
        ("force_limit", -8000.0),
    ],
)
def test_refuses_senseless_parameters(name, value):
    with pytest.raises(ParameterError, match=f"{name} = {value}: expected a finite number"):
        PidParameters(**{name: value})


def test_refuses_a_senseless_time_step():
    with pytest.raises(ParameterError, match="time_step = 0"):
        Pid(time_step=0.0)


def test_under_a_limit_of_zero_it_does_not_creep():
    """What the integrator gathers on the way to 15 m/s drives nobody over a stop line."""
    pid = Pid(PidParameters(reference_speed=15.0))
    drive(pid, 0.0, 300)
    speed, crept = 0.0, 0.0
    for _ in range(2000):
        u = pid.control(speed, math.inf, 0.0)
        speed = max(0.0, MODEL.decay * speed + MODEL.speed_per_force * u)
        crept += 0.05 * speed
    assert crept == 0.0
