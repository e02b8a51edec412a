"""The solver CVode of SUNDIALS: implicit, with variable order and step, also for stiff systems.

Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363. FMPy brings the compiled libraries; its own
solver class is not used, because it only prints errors of the FMU and goes on.
"""

from ctypes import CFUNCTYPE, byref, c_double, c_int, c_int64, c_long, c_void_p
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmus.fmi.continuous import (
    LONGEST,
    SMALLEST,
    ContinuousSystem,
    IntegrationError,
    UndefinedError,
)

# The solver starts again at every step of the co-simulation. Local errors of one sign add up over
# hundreds of them, so one internal step may use only this share of the tolerance.
_SHARE = 0.01
_BDF, _ONE_STEP = c_int(2), c_int(2)
_REASONS = {
    -3: "the error test fails however small the step is",
    -4: "Newton's method does not converge however small the step is",
    -6: "its linear system cannot be solved",
    -8: "the right-hand side fails",
    -9: "the right-hand side is undefined at the start",
    -10: "the right-hand side is undefined again and again",
    -11: "the right-hand side is undefined at the end of a step",
}
_TRY_SMALLER, _GIVE_UP = 1, -1
_RightHandSide = CFUNCTYPE(c_int, c_double, c_void_p, c_void_p, c_void_p)


def available() -> bool:
    """Return whether FMPy has SUNDIALS for this platform."""
    try:
        _libraries()
    except Exception:  # loading a foreign library can raise any exception
        return False
    return True


def _libraries() -> Any:
    from fmpy.sundials import libraries  # checks SUNDIALS' version

    return libraries


class Cvode:
    """Backward differentiation formulas with a dense Jacobian from differences.

    Args:
        system: System to integrate; at least one state.
        tolerance: Relative tolerance; the absolute one is this times a state's nominal value.
    """

    remedy = "a greater `tolerance`"

    def __init__(self, system: ContinuousSystem, tolerance: float) -> None:
        found = _libraries()
        self._cvode, self._core = found.sundials_cvode, found.sundials_core
        self._vectors = found.sundials_nvecserial
        self._system, self._tolerance = system, _SHARE * tolerance
        self._views: dict[int, NDArray[np.float64]] = {}
        self._problem: BaseException | None = None
        self._undefined = ""
        self._reached, self._time = c_double(), 0.0
        self._right_hand_side = _RightHandSide(self._evaluate)  # must outlive the solver
        self._address = self._vectors["N_VGetArrayPointer_Serial"]
        self._address.restype, self._address.argtypes = c_void_p, [c_void_p]
        self._step = self._cvode["CVode"]

        self._context = c_void_p()
        self._core["SUNContext_Create"](c_int(0), byref(self._context))
        self._core["SUNContext_ClearErrHandlers"](self._context)  # handlers and logger would print
        self._core["SUNContext_SetLogger"](self._context, None)
        n = c_int64(system.nx)
        self._state, self._absolute, self._between = (
            self._create(self._vectors["N_VNew_Serial"], n) for _ in range(3)
        )
        self.x = self._view(self._state)
        self._memory = self._create(self._cvode["CVodeCreate"], _BDF)
        self._require("CVodeInit", self._right_hand_side, c_double(0.0), self._state)
        self._matrix = self._create(found.sundials_sunmatrixdense["SUNDenseMatrix"], n, n)
        solve = found.sundials_sunlinsoldense["SUNLinSol_Dense"]
        self._linear = self._create(solve, self._state, self._matrix)
        self._view(self._absolute)[:] = self._tolerance
        self._require("CVodeSVtolerances", c_double(self._tolerance), self._absolute)
        self._require("CVodeSetLinearSolver", self._linear, self._matrix)
        self._require("CVodeSetMaxNumSteps", c_long(-1))  # giveway counts them
        if system.nz:
            self._require("CVodeSetMaxStep", c_double(LONGEST))

    def restart(  # noqa: D102 - as in Solver
        self, time: float, x: NDArray[np.float64], nominals: NDArray[np.float64]
    ) -> None:
        self._time = time
        self.x[:] = x
        self._view(self._absolute)[:] = self._tolerance * nominals
        self._require("CVodeReInit", c_double(time), self._state)
        self._require("CVodeSetMinStep", c_double(SMALLEST * max(1.0, abs(time))))

    def expect_events(self) -> None:
        """Do nothing: CVode always starts with small steps."""

    def step(self, stop: float) -> float:  # noqa: D102
        self._undefined = ""
        self._require("CVodeSetStopTime", c_double(stop))
        status = self._step(
            self._memory, c_double(stop), self._state, byref(self._reached), _ONE_STEP
        )
        if self._problem is not None:
            problem, self._problem = self._problem, None
            raise problem
        if status < 0:
            why = self._undefined or _REASONS.get(status, f"CVode returned {status}")
            raise IntegrationError(f"{why}; no step from {self._time:.9g} s is small enough")
        self._time = self._reached.value
        return self._time

    def at(self, time: float) -> NDArray[np.float64]:  # noqa: D102
        self._require("CVodeGetDky", c_double(time), c_int(0), self._between)
        return self._view(self._between)

    def close(self) -> None:  # noqa: D102
        if self._memory is not None:
            memory, self._memory = self._memory, None
            self._cvode["CVodeFree"](byref(memory))
            self._core["SUNLinSolFree"](self._linear)
            self._core["SUNMatDestroy"](self._matrix)
            for vector in (self._state, self._absolute, self._between):
                self._vectors["N_VDestroy_Serial"](vector)
            self._core["SUNContext_Free"](byref(self._context))

    def _evaluate(self, time: float, x: int, slope: int, _data: int | None) -> int:
        """Evaluate the right-hand side for CVode; the FMU reads and writes CVode's own vectors."""
        try:
            target = self._address(slope)
            self._system.derivatives(time, self._address(x), target)
            self._undefined = self._system.undefined(self._at_address(target), time)
        except UndefinedError as undefined:
            self._undefined = str(undefined)
        except BaseException as error:  # no exception may reach C
            self._problem = error
            return _GIVE_UP
        return _TRY_SMALLER if self._undefined else 0

    def _create(self, function: Any, *arguments: Any) -> Any:
        """Return an object of SUNDIALS, in its context."""
        function.restype = c_void_p
        pointer = function(*arguments, self._context)
        if not pointer:
            raise IntegrationError("CVode is out of memory")
        return c_void_p(pointer)

    def _require(self, name: str, *arguments: Any) -> None:
        status = self._cvode[name](self._memory, *arguments)
        if status < 0:
            raise IntegrationError(f"{name} returned {status} at {self._time:.9g} s")

    def _view(self, vector: c_void_p) -> NDArray[np.float64]:
        return self._at_address(self._address(vector))

    def _at_address(self, address: int) -> NDArray[np.float64]:
        view = self._views.get(address)
        if view is None:
            array = (c_double * self._system.nx).from_address(address)
            view = self._views[address] = np.ctypeslib.as_array(array)
        return view
