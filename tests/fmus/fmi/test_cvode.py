"""Integrators: their error and what they give between two steps."""

from __future__ import annotations

import ctypes
from math import cos, sin

import numpy as np
import pytest

from fmus.fmi import cvode
from fmus.fmi.continuous import UndefinedError
from fmus.fmi.cvode import Cvode
from fmus.fmi.runge_kutta import RungeKutta

SOLVERS = [
    "rk4",
    pytest.param(
        "cvode", marks=pytest.mark.skipif(not cvode.available(), reason="no SUNDIALS here")
    ),
]


@pytest.fixture(params=SOLVERS)
def solver(request):
    return request.param


class Oscillator:
    """x'' = -x, with states x and x'."""

    nx, nz = 2, 0
    wrong_from = 99.0  # [s]

    def derivatives(self, time, x, slope):
        (a, b), out = ((ctypes.c_double * 2).from_address(p) for p in (x, slope))
        out[0], out[1] = b, -a
        if time > self.wrong_from:
            raise UndefinedError("too late")

    def undefined(self, slope, time):
        return "" if np.isfinite(slope).all() else "odd"


def integrated(solver, end):
    solver.restart(0.0, np.array([0.0, 1.0]), np.ones(2))
    time = 0.0
    while time < end:
        time = solver.step(end)
    return solver.x


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_the_error_follows_the_tolerance(kind, tolerance):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    solver = kind(Oscillator(), tolerance)
    try:
        x = integrated(solver, 4.0)
        assert x == pytest.approx([sin(4.0), cos(4.0)], abs=10 * tolerance)
    finally:
        solver.close()


@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_states_between_two_steps(kind):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    solver = kind(Oscillator(), 1e-8)
    try:
        solver.restart(0.0, np.array([0.0, 1.0]), np.ones(2))
        time = before = 0.0
        for _ in range(20):
            before, time = time, solver.step(3.0)
        middle = 0.5 * (before + time)
        assert solver.at(middle) == pytest.approx([sin(middle), cos(middle)], abs=1e-6)
    finally:
        solver.close()
