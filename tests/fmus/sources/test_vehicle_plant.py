"""The motion: the paper's recursion bit by bit, the exact solution, and standing still."""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fmus import VehicleFmu, bundled_fmu

DT = 0.05  # [s]
masses = st.floats(200.0, 40_000.0)  # [kg]
frictions = st.floats(0.0, 2_000.0)  # [N.s/m]
speeds = st.floats(0.0, 40.0)  # [m/s]
forces = st.lists(st.floats(-30_000.0, 30_000.0), min_size=1, max_size=40)  # [N]


def run(version, forces, *, dt=DT, position=0.0, speed=0.0, **start_values):
    """The states (position, speed) after each step."""
    with VehicleFmu(bundled_fmu(version), step_size=dt, start_values=start_values) as vehicle:
        vehicle.start(position=position, speed=speed)
        states = [(vehicle.position, vehicle.speed)]
        for force in forces:
            vehicle.step(force)
            states.append((vehicle.position, vehicle.speed))
    return np.array(states)


def euler(M, alpha, forces, *, dt=DT, position=0.0, speed=0.0, reverse=False):
    """Yang & Özgüner 2019, the discrete plant x(k+1) = A x(k) + B u(k), in numpy."""
    A = np.array([[1.0, dt], [0.0, 1.0 - alpha * dt / M]])
    B = np.array([0.0, dt / M])
    x = np.array([position, speed])
    states = [x]
    for u in forces:
        x = np.array([x[0] + A[0, 1] * x[1], A[1, 1] * x[1] + B[1] * u])
        if not reverse:
            x[1] = max(x[1], 0.0)
        states.append(x)
    return np.array(states)


def free_motion(t, M, alpha, u, s0, v0):
    """The solution of M s'' + alpha s' = u, for alpha > 0 and a constant u, to 50 digits."""
    t, M, alpha, u, s0, v0 = map(Decimal, (t, M, alpha, u, s0, v0))
    with localcontext(prec=50):
        v_end, tau = u / alpha, M / alpha
        faded = 1 - (-t / tau).exp()
        s = s0 + v_end * t + (v0 - v_end) * tau * faded
        v = v0 + (v_end - v0) * faded
    return float(s), float(v)


def free_stop(M, alpha, brake, v0):
    """Time and place where that solution with u = -brake stands still, to 50 digits."""
    M, alpha, brake, v0 = map(Decimal, (M, alpha, brake, v0))
    with localcontext(prec=50):
        t = M / alpha * (1 + alpha * v0 / brake).ln()
        return float(t), float((M * v0 - brake * t) / alpha)


# ---- forward Euler ----


@pytest.mark.parametrize("reverse", [False, True])
def test_euler_is_the_papers_recursion_to_the_bit_in_a_long_run(fmi_version, reverse):
    forces = np.random.default_rng(7).uniform(-6000.0, 6000.0, 20_000)
    ours = run(fmi_version, forces, speed=4.0, M=1000.0, alpha=100.0, reverse=reverse)
    assert np.array_equal(ours, euler(1000.0, 100.0, forces, speed=4.0, reverse=reverse))


@settings(max_examples=60)
@given(masses, frictions, speeds, forces, st.booleans(), st.floats(0.001, 0.2))
def test_euler_is_bit_equal_for_any_vehicle_and_force(M, alpha, speed, forces, reverse, dt):
    expected = euler(M, alpha, forces, dt=dt, position=-3.0, speed=speed, reverse=reverse)
    for version in ("2.0", "3.0"):
        ours = run(
            version, forces, dt=dt, position=-3.0, speed=speed, M=M, alpha=alpha, reverse=reverse
        )
        assert np.array_equal(ours, expected)


# ---- exact discretisation ----

TINY = 1e-300  # numbers near the smallest have few digits


@settings(max_examples=60)
@given(
    masses,
    st.floats(1.0, 2_000.0),
    speeds,
    st.floats(-30_000.0, 30_000.0),
    st.floats(0.001, 2.0),
)
def test_the_exact_step_is_the_solution_of_the_equation(M, alpha, speed, u, dt):
    ours = run("2.0", [u], dt=dt, speed=speed, M=M, alpha=alpha, exact=True, reverse=True)
    s, v = free_motion(dt, M, alpha, u, 0.0, speed)
    gain = abs(u) / M * dt  # [m/s] what the force adds; v and s may be small differences
    assert ours[1, 0] == pytest.approx(s, rel=0.0, abs=2e-15 * (speed + gain) * dt + TINY)
    assert ours[1, 1] == pytest.approx(v, rel=0.0, abs=2e-15 * (speed + gain) + TINY)


def test_without_friction_the_exact_step_is_the_parabola(fmi_version):
    ours = run(fmi_version, [3000.0] * 20, speed=2.0, M=1500.0, alpha=0.0, exact=True)
    t = DT * np.arange(21)
    assert ours[:, 0] == pytest.approx(2.0 * t + t**2, abs=1e-12)
    assert ours[:, 1] == pytest.approx(2.0 + 2.0 * t, abs=1e-12)


@settings(max_examples=30)
@given(masses, st.floats(0.0, 2_000.0), speeds, st.floats(-30_000.0, 30_000.0))
def test_an_exact_step_can_be_cut_in_pieces(M, alpha, speed, u):
    whole = run("2.0", [u], dt=0.4, speed=speed, M=M, alpha=alpha, exact=True)[-1]
    pieces = run("2.0", [u] * 8, dt=0.05, speed=speed, M=M, alpha=alpha, exact=True)[-1]
    assert whole == pytest.approx(pieces, rel=1e-11, abs=1e-11)


def test_euler_converges_to_the_exact_solution_with_first_order(fmi_version):
    def gap(halvings):
        n = 20 * 2**halvings
        fine = run(fmi_version, [1500.0] * n, dt=1.0 / n, speed=3.0)
        return abs(fine[-1] - free_motion(1.0, 1000.0, 100.0, 1500.0, 0.0, 3.0))

    ratios = gap(3) / gap(4)
    assert ratios == pytest.approx([2.0, 2.0], rel=0.02)


# ---- standing still ----


@settings(max_examples=60)
@given(masses, frictions, speeds, forces, st.booleans())
def test_brakes_never_drive_backwards(M, alpha, speed, forces, exact):
    states = run("2.0", forces, speed=speed, M=M, alpha=alpha, exact=exact)
    assert (states[:, 1] >= 0.0).all()
    assert (np.diff(states[:, 0]) >= 0.0).all()


@pytest.mark.parametrize("exact", [False, True])
def test_a_standing_car_is_held_and_drives_off_again(fmi_version, exact):
    states = run(fmi_version, [-5000.0] * 5 + [2000.0], exact=exact)
    assert np.array_equal(states[:6], np.zeros((6, 2)))
    assert states[6, 1] > 0.0


@settings(max_examples=60)
@given(masses, st.floats(5.0, 2_000.0), st.floats(0.1, 40.0), st.floats(10.0, 30_000.0))
def test_the_exact_stop_is_where_the_equation_stops(M, alpha, speed, brake):
    t, s = free_stop(M, alpha, brake, speed)
    ours = run("2.0", [-brake], dt=1.01 * t, speed=speed, M=M, alpha=alpha, exact=True)
    assert ours[1, 1] == 0.0
    assert ours[1, 0] == pytest.approx(s, rel=2e-15)


def test_the_exact_stop_without_friction_is_v_squared_over_two_a(fmi_version):
    states = run(fmi_version, [-4000.0] * 40, speed=4.02, M=1000.0, alpha=0.0, exact=True)
    assert states[-1] == pytest.approx([4.02**2 / 8.0, 0.0], abs=1e-12)


def test_reverse_lets_a_negative_force_drive_backwards(fmi_version):
    states = run(fmi_version, [-1000.0] * 3, reverse=True)
    assert states[-1, 1] < -0.14


# ---- acceleration ----


@pytest.mark.parametrize("exact", [False, True])
def test_acceleration_is_the_change_of_speed_over_the_last_step(fmi_version, exact):
    path, dt = bundled_fmu(fmi_version), 0.07
    with VehicleFmu(path, step_size=dt, start_values={"exact": exact}) as vehicle:
        vehicle.start(speed=0.5)
        assert vehicle.acceleration == 0.0
        for force in np.random.default_rng(5).uniform(-3000.0, 4000.0, 100):
            before = vehicle.speed
            vehicle.step(force)
            assert vehicle.acceleration == (vehicle.speed - before) / dt
