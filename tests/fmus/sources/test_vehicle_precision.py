"""The exact discretisation against 60 digits, over everything a vehicle can be.

Friction from none to so much that the car stops within a step: where the textbook's formula
divides by alpha or subtracts two nearly equal terms, ours must not lose a digit.
"""

from __future__ import annotations

from decimal import Decimal, localcontext

from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from fmus import VehicleFmu, bundled_fmu

SETTINGS = settings(max_examples=100)
masses = st.floats(0.5, 1e5)  # [kg]
frictions = st.one_of(st.just(0.0), st.floats(1e-9, 1e7))  # [N.s/m]
steps = st.floats(1e-3, 1.0)  # [s]
ROUNDING = Decimal("2e-15")  # a few units in the last place of a double
SMALLEST = Decimal("1e-300")  # below, doubles have fewer digits


def step(v, u, dt, **start_values):
    """Position and speed after one step from the origin."""
    path, values = bundled_fmu("2.0"), {"exact": True, **start_values}
    with VehicleFmu(path, step_size=dt, start_values=values) as vehicle:
        vehicle.start(speed=v)
        vehicle.step(u)
        return Decimal(vehicle.position), Decimal(vehicle.speed)


def free_motion(v, u, dt, M, alpha):
    """M s'' + alpha s' = u from the origin, after dt."""
    if alpha == 0:
        return v * dt + u / M * dt * dt / 2, v + u / M * dt
    terminal, decay = u / alpha, (-alpha * dt / M).exp()
    position = terminal * dt + (v - terminal) * M / alpha * (1 - decay)
    return position, terminal + (v - terminal) * decay


def standstill(v, u, M, alpha):
    """The same motion up to v = 0: where and when."""
    if alpha == 0:
        return -M * v * v / (2 * u), -M * v / u
    time = M / alpha * (1 - alpha * v / u).ln()
    return (M * v + u * time) / alpha, time


@SETTINGS
@given(v=st.floats(-40.0, 40.0), u=st.floats(-3e4, 3e4), dt=steps, M=masses, alpha=frictions)
@example(v=4.0, u=1000.0, dt=0.05, M=1000.0, alpha=0.0)
@example(v=4.0, u=1000.0, dt=1.0, M=0.5, alpha=1e7)
def test_a_step_is_right_to_the_last_digits(v, u, dt, M, alpha):
    s_end, v_end = step(v, u, dt, M=M, alpha=alpha, reverse=True)
    with localcontext(prec=60):
        v, u, dt, M, alpha = map(Decimal, (v, u, dt, M, alpha))
        expected_s, expected_v = free_motion(v, u, dt, M, alpha)
        gain = abs(u) * dt / M  # what the force alone would do
        assert abs(v_end - expected_v) <= ROUNDING * (abs(v) + gain) + SMALLEST
        assert abs(s_end - expected_s) <= ROUNDING * (abs(v) + gain) * dt + SMALLEST


@SETTINGS
@given(v=st.floats(1e-3, 40.0), u=st.floats(-3e4, -1e-3), dt=steps, M=masses, alpha=frictions)
@example(v=10.0, u=-8000.0, dt=1.0, M=500.0, alpha=0.0)
@example(v=10.0, u=-1e-3, dt=1.0, M=0.5, alpha=1e3)
def test_a_stop_within_a_step_is_where_the_equation_stops(v, u, dt, M, alpha):
    s_end, v_end = step(v, u, dt, M=M, alpha=alpha)
    with localcontext(prec=60):
        distance, time = standstill(*map(Decimal, (v, u, M, alpha)))
        assume(abs(time / Decimal(dt) - 1) > Decimal("1e-9"))  # either answer is right there
        assert (v_end == 0) == (time < Decimal(dt))
        if v_end == 0:
            assert abs(s_end / distance - 1) <= 2 * ROUNDING
