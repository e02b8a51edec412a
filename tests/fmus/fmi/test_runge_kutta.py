"""Runge-Kutta: its order and the times of its stages."""

from __future__ import annotations

import ctypes
from itertools import pairwise
from math import log, sin

import numpy as np
import pytest

from fmus.fmi import cvode
from fmus.fmi.continuous import IntegrationError, UndefinedError
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


def test_runge_kutta_is_of_order_four():
    errors = []
    for h in (0.2, 0.1, 0.05):
        solver, x = RungeKutta(Oscillator(), 1e-6), np.array([0.0, 1.0])
        for k in range(round(4.0 / h)):
            x = solver._classical(k * h, x, h)
        errors.append(abs(x[0] - sin(4.0)))
    orders = [log(coarse / fine, 2) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([4.0, 4.0], abs=0.15)


class Clock:
    """x' = 4 t^3, a function of the time alone, which Runge-Kutta's weights (Simpson's) know."""

    nx, nz = 1, 0

    def derivatives(self, time, x, slope):
        ctypes.c_double.from_address(slope).value = 4.0 * time**3

    def undefined(self, slope, time):
        return ""


def test_every_stage_of_a_step_has_its_time():
    solver = RungeKutta(Clock(), 1e-6)
    solver.restart(1.0, np.array([1.0]), np.ones(1))
    time = 1.0
    while time < 3.0:
        time = solver.step(3.0)
        assert solver.x[0] == pytest.approx(time**4, rel=1e-13)


def integrated(solver, end):
    solver.restart(0.0, np.array([0.0, 1.0]), np.ones(2))
    time = 0.0
    while time < end:
        time = solver.step(end)
    return solver.x


@pytest.mark.parametrize("kind", [RungeKutta, Cvode])
def test_a_point_that_cannot_be_passed_ends_the_integration(kind):
    if kind is Cvode and not cvode.available():
        pytest.skip("no SUNDIALS here")
    system = Oscillator()
    system.wrong_from = 1.0
    solver = kind(system, 1e-6)
    try:
        with pytest.raises(IntegrationError, match=r"too late; no step from (0.999|1 s)"):
            integrated(solver, 2.0)
    finally:
        solver.close()
