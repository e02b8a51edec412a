"""The step-halving check: one step is compared with two halves before a run.

A solver that is too coarse for its model diverges without any error: one OpenModelica export
reaches 1e14 m/s at steps of 50 ms and returns OK. First-order methods such as forward Euler pass,
since their error is of the size of one step's change.
"""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from fmus.checking.manoeuvres import Opener, Phase, Trace, try_to_drive
from fmus.errors import (
    FmuCrashError,
    FmuError,
    FmuInterfaceError,
    FmuOutputError,
    FmuProfileError,
    FmuStartError,
)
from fmus.isolation import processes_reused

DIVISORS = (1, 2, 5, 10, 20, 50, 100)  # divisors of the step, from coarse to fine
RELATIVE = 0.05  # largest difference, relative to the largest speed or distance of the finer run
SPEED_FLOOR = 0.05  # Speed difference [m/s] that is always allowed
POSITION_FLOOR = 0.05  # Position difference [m] that is always allowed
LARGEST_ACCELERATION = 15.0  # [m/s2] bound of the change in one step
DRIVE, COAST, BRAKE = 1.0, 0.5, 1.5  # [s] durations of the manoeuvre's parts

_UNABLE = (FmuInterfaceError, FmuProfileError, FmuStartError)  # the FMU cannot do this step


@dataclass(frozen=True)
class Disagreement:
    """The largest difference between a run with coarse steps and one with finer steps."""

    quantity: str  # "speed" or "position"
    unit: str
    time: float  # [s]
    coarse: float
    fine: float


@dataclass(frozen=True)
class Convergence:
    """The result of the self-check.

    Attributes:
        step: Step of the FMU in the run [s].
        finer: Step [s] with which it was compared, or None if the FMU can do no finer steps.
        problem: Reason why ``step`` is too coarse, one clause; empty if it is not.
        advised: Largest step [s] that converges, or None if none was found or none is needed.
        traces: Traces of the manoeuvre from the start speed with ``step`` and ``finer``, if they
            ran.
    """

    step: float
    finer: float | None
    problem: str = ""
    advised: float | None = None
    traces: tuple[Trace, ...] = ()


def require_converged(
    opener: Opener,
    fmu_step: float,
    *,
    path: Path,
    force: float = 4000.0,
    start_speed: float = 0.0,
) -> Convergence:
    """Let a vehicle drive, coast and brake at its step and at finer ones, and compare.

    Args:
        opener: Function that makes the vehicle for a step of its FMU; the time for which a force is
            held does not change.
        fmu_step: Step of the FMU in the run [s].
        path: Path of the FMU, for messages.
        force: Force [N] that drives and brakes.
        start_speed: Start speed of the run [m/s]; the manoeuvre is driven from it and from rest.

    Raises:
        FmuOutputError: the steps are too coarse; the message names one that is not.
        FmuError: the FMU fails at every step.
    """
    result = convergence(opener, fmu_step, force=force, start_speed=start_speed)
    if result.problem:
        raise FmuOutputError(f"{path}: {result.problem}; {remedy(result)}")
    return result


def remedy(result: Convergence) -> str:
    """Return the advice about steps that are too coarse."""
    if result.advised is None:
        finest = milliseconds(result.step / DIVISORS[-1])
        return (
            f"no step down to {finest} converges either: this FMU's solver does not fit its model; "
            "export it with another solver, or set `kind = 'model-exchange'` in [fmu] if it can"
        )
    return f"add `step = {result.advised:g}` to [fmu] of the profile"


@processes_reused()
def convergence(
    opener: Opener, fmu_step: float, *, force: float = 4000.0, start_speed: float = 0.0
) -> Convergence:
    """Return the self-check's finding; see :func:`require_converged`.

    Raises:
        FmuError: the FMU fails, and smaller steps do not change that.
    """
    sizes = _StepSizes(opener, fmu_step, force, start_speed)
    whole = sizes.run(1)
    if isinstance(whole.error, _UNABLE):
        raise whole.error
    fine = sizes.first_able()
    if whole.error is not None:
        advised = sizes.first_converged()
        diverges = isinstance(whole.error, FmuOutputError) and sizes.depends_on_step()
        if advised is None and not diverges:
            raise whole.error
        problem = f"{_do_not_converge(fmu_step)} ({plain(whole.error).split('; ')[0]})"
    elif fine is None:
        return Convergence(fmu_step, None, traces=whole.shown)
    else:
        problem = sizes.problem(1, fine)
        advised = sizes.first_converged() if problem else None
    shown = whole.shown + (() if fine is None else sizes.run(fine).shown)
    return Convergence(
        fmu_step,
        None if fine is None else fmu_step / fine,
        problem,
        None if advised is None else fmu_step / advised,
        shown,
    )


@dataclass(frozen=True)
class _Drives:
    """The manoeuvres driven with steps of one size."""

    traces: tuple[Trace, ...]  # traces up to the end or the failure
    error: FmuError | None

    @property
    def shown(self) -> tuple[Trace, ...]:
        """The last manoeuvre that has begun, in a tuple, or an empty one."""
        return self.traces[-1:]

    @property
    def steps_done(self) -> int:
        """The number of steps before the end or the failure."""
        return sum(trace.force.size for trace in self.traces)


class _StepSizes:
    """The manoeuvres at the step and at its divisions, each driven when it is first needed."""

    def __init__(self, opener: Opener, step: float, force: float, start_speed: float) -> None:
        self._opener = opener
        self._step = step
        self._force = force
        self._speeds = sorted({0.0, start_speed})
        self._drives: dict[int, _Drives] = {}

    def run(self, divisor: int) -> _Drives:
        """Return the drives of one divisor.

        Raises:
            FmuCrashError: a dead process shows nothing about steps, and a hang costs minutes.
        """
        if divisor not in self._drives:
            self._drives[divisor] = self._attempt(None if divisor == 1 else self._step / divisor)
        return self._drives[divisor]

    def first_able(self) -> int | None:
        """Return the coarsest finer step that the FMU can do; some FMUs can do only their own."""
        return next((d for d in DIVISORS[1:] if self.run(d).error is None), None)

    def problem(self, coarse: int, fine: int) -> str:
        """Return why the coarse step is too coarse, or an empty text if it is not."""
        for one, two in zip(self.run(coarse).traces, self.run(fine).traces, strict=True):
            found = compare(one, two)
            if found:
                return (
                    f"{_do_not_converge(self._step / coarse)}: {found.quantity} "
                    f"{found.coarse:.3g} {found.unit} at {found.time:.3g} s, "
                    f"{found.fine:.3g} {found.unit} with {milliseconds(self._step / fine)}"
                )
        return ""

    def first_converged(self) -> int | None:
        """Return the coarsest of the finer steps that agrees with the next finer one."""
        able = [divisor for divisor in DIVISORS[1:] if self.run(divisor).error is None]
        for coarse, fine in pairwise(able):
            if not self.problem(coarse, fine):
                return coarse
        return None

    def depends_on_step(self) -> bool:
        """Return whether the time or the kind of the failure depends on the step."""
        able = [drives for drives in self._drives.values() if not isinstance(drives.error, _UNABLE)]
        done = [drives.steps_done for drives in able]
        blamed = {plain(r.error).split()[0] for r in able if isinstance(r.error, FmuOutputError)}
        return max(done) - min(done) > 1 or len(blamed) > 1

    def _attempt(self, step: float | None) -> _Drives:
        attempts = try_to_drive(self._speeds, self._opener, manoeuvre(self._force), fmu_step=step)
        error = attempts[-1].error
        if isinstance(error, FmuCrashError):
            raise error
        return _Drives(tuple(a.trace for a in attempts if a.trace is not None), error)


def _do_not_converge(step: float) -> str:
    return f"its steps of {milliseconds(step)} do not converge"


def manoeuvre(force: float) -> list[Phase]:
    """Return the phases: drive, coast, brake."""
    return [Phase(force, DRIVE), Phase(0.0, COAST), Phase(-force, BRAKE)]


def compare(coarse: Trace, fine: Trace) -> Disagreement | None:
    """Return the worst difference of two drives under the same forces, or None if they agree.

    First-order methods pass: a finer run may differ by what one step changes, and by 5 %.
    """
    step = coarse.step_size
    change = min(float(np.abs(np.diff(fine.speed)).max()), LARGEST_ACCELERATION * step)
    fastest = float(np.abs(fine.speed).max())
    travel = float(np.abs(fine.position - fine.position[0]).max())
    bounds = (
        ("speed", "m/s", SPEED_FLOOR + RELATIVE * min(fastest, 100.0) + change),
        ("position", "m", POSITION_FLOOR + RELATIVE * min(travel, 1000.0)
         + min(fastest, 100.0) * step),
    )  # fmt: skip
    worst: Disagreement | None = None
    excess = 1.0
    for quantity, unit, bound in bounds:
        one, two = getattr(coarse, quantity), getattr(fine, quantity)
        ratio = np.abs(one - two) / bound
        at = int(np.argmax(ratio))
        if ratio[at] > excess:
            excess = float(ratio[at])
            worst = Disagreement(quantity, unit, at * step, float(one[at]), float(two[at]))
    return worst


def milliseconds(step: float) -> str:
    """Return a step as text: ``50 ms``."""
    return f"{1000.0 * step:.4g} ms"


def plain(error: FmuError) -> str:
    """Return an error without the path with which the whole message begins."""
    text = str(error)
    head, separator, rest = text.partition(": ")
    return rest if separator and (".fmu" in head or "/" in head) else text
