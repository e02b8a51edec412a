"""Does an FMU's result depend on the size of its steps? One step against two halves, before a run.

A solver that is too coarse for its model diverges without a word: one OpenModelica export reaches
1e14 m/s at steps of 50 ms and returns OK. Whatever converges with first order, as forward Euler
does, passes: its error is of the size of one step's change.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fmus.checking.manoeuvres import Phase, Trace, try_to_drive
from fmus.errors import (
    FmuCrashError,
    FmuError,
    FmuInterfaceError,
    FmuOutputError,
    FmuProfileError,
    FmuStartError,
)

if TYPE_CHECKING:
    from pathlib import Path

    from fmus.checking.manoeuvres import Opener

DIVISORS = (1, 2, 5, 10, 20, 50, 100)  # of the step; what is tried, coarse to fine
RELATIVE = 0.05  # of the largest speed or way of the finer run
SPEED_FLOOR = 0.05  # [m/s]
POSITION_FLOOR = 0.05  # [m]
LARGEST_ACCELERATION = 15.0  # [m/s2] of a road vehicle; what one step may change
_CLEARLY = 0.1  # [m/s2]
DRIVE, COAST, BRAKE = 1.0, 0.5, 1.5  # [s] of the manoeuvre's parts

_UNABLE = (FmuInterfaceError, FmuProfileError, FmuStartError)  # at a finer step: it cannot be had


@dataclass(frozen=True)
class Disagreement:
    """Where a run with steps of one size leaves that with finer ones."""

    quantity: str  # "speed" or "position"
    unit: str
    time: float  # [s]
    coarse: float
    fine: float


@dataclass(frozen=True)
class Convergence:
    """What the self-check found.

    Attributes:
        step: the FMU's, as the run would take it [s].
        finer: what it was compared with [s]; None: the FMU can do no finer steps.
        problem: why ``step`` is too coarse, one clause; empty if it is not.
        advised: the largest step that converges [s]; None: none was found, or none is needed.
        traces: of the manoeuvre from the start speed: with ``step`` and ``finer``, where they ran.
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
    """Have a vehicle drive, coast and brake at its step and at finer ones, and compare.

    Args:
        opener: makes the vehicle for a step of its FMU; how long a force is held stays the same.
        fmu_step: the FMU's in the run [s].
        path: of the FMU, for messages.
        force: that drives and brakes [N].
        start_speed: of the run [m/s]; the manoeuvre is driven from it and from rest.

    Raises:
        FmuOutputError: the steps are too coarse; the message names one that is not.
        FmuError: the FMU fails at every step.
    """
    result = convergence(opener, fmu_step, force=force, start_speed=start_speed)
    if result.problem:
        raise FmuOutputError(f"{path}: {result.problem}; {remedy(result)}")
    return result


def remedy(result: Convergence) -> str:
    """What to do about steps that are too coarse."""
    if result.advised is None:
        finest = milliseconds(result.step / DIVISORS[-1])
        return (
            f"no step down to {finest} converges either: this FMU's solver does not fit its model; "
            "export it with another solver, or set `kind = 'model-exchange'` in [fmu] if it can"
        )
    return f"add `step = {result.advised:g}` to [fmu] of the profile"


def convergence(
    opener: Opener, fmu_step: float, *, force: float = 4000.0, start_speed: float = 0.0
) -> Convergence:
    """The self-check's finding; see :func:`require_converged`.

    Raises:
        FmuError: the FMU fails, and smaller steps do not change that.
    """
    ladder = _Ladder(opener, fmu_step, force, start_speed)
    whole = ladder.run(1)
    if isinstance(whole.error, _UNABLE):
        raise whole.error
    fine = ladder.first_able()
    if whole.error is not None:
        advised = ladder.first_converged()
        diverges = isinstance(whole.error, FmuOutputError) and ladder.depends_on_step()
        if advised is None and not diverges:
            raise whole.error
        problem = f"{_do_not_converge(fmu_step)} ({plain(whole.error).split('; ')[0]})"
    elif fine is None:
        return Convergence(fmu_step, None, traces=whole.shown)
    else:
        problem = ladder.problem(1, fine)
        advised = ladder.first_converged() if problem else None
    shown = whole.shown + (() if fine is None else ladder.run(fine).shown)
    return Convergence(
        fmu_step,
        None if fine is None else fmu_step / fine,
        problem,
        None if advised is None else fmu_step / advised,
        shown,
    )


@dataclass(frozen=True)
class _Rung:
    """The manoeuvres with steps of one size."""

    traces: tuple[Trace, ...]  # as far as they went
    error: FmuError | None

    @property
    def shown(self) -> tuple[Trace, ...]:
        """The last manoeuvre, if it was begun."""
        return self.traces[-1:]

    @property
    def steps_done(self) -> int:
        """Before the end, or before it failed."""
        return sum(trace.force.size for trace in self.traces)


class _Ladder:
    """The step and what it can be divided by; each is run once, when it is asked for."""

    def __init__(self, opener: Opener, step: float, force: float, start_speed: float) -> None:
        self._opener = opener
        self._step = step
        self._force = force
        self._speeds = sorted({0.0, start_speed})
        self._rungs: dict[int, _Rung] = {}

    def run(self, divisor: int) -> _Rung:
        """The rung of one divisor.

        Raises:
            FmuCrashError: a dead process says nothing about steps, and a hang costs minutes.
        """
        if divisor not in self._rungs:
            self._rungs[divisor] = self._attempt(None if divisor == 1 else self._step / divisor)
        return self._rungs[divisor]

    def first_able(self) -> int | None:
        """The coarsest of the finer steps that the FMU does: some refuse those not theirs."""
        return next((d for d in DIVISORS[1:] if self.run(d).error is None), None)

    def problem(self, coarse: int, fine: int) -> str:
        """Why the coarse step will not do; empty if it will."""
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
        """The coarsest of the finer steps that agrees with the one below it."""
        able = [divisor for divisor in DIVISORS[1:] if self.run(divisor).error is None]
        for coarse, fine in pairwise(able):
            if not self.problem(coarse, fine):
                return coarse
        return None

    def depends_on_step(self) -> bool:
        """Whether how far the FMU comes before it fails, or what fails, depends on its step."""
        able = [rung for rung in self._rungs.values() if not isinstance(rung.error, _UNABLE)]
        done = [rung.steps_done for rung in able]
        blamed = {plain(r.error).split()[0] for r in able if isinstance(r.error, FmuOutputError)}
        return max(done) - min(done) > 1 or len(blamed) > 1

    def _attempt(self, step: float | None) -> _Rung:
        traces = []
        for speed in self._speeds:
            attempt = try_to_drive(self._opener, manoeuvre(self._force), speed=speed, fmu_step=step)
            if isinstance(attempt.error, FmuCrashError):
                raise attempt.error
            if attempt.trace is not None:
                traces.append(attempt.trace)
            if attempt.error is not None:
                return _Rung(tuple(traces), attempt.error)
        return _Rung(tuple(traces), None)


def _do_not_converge(step: float) -> str:
    return f"its steps of {milliseconds(step)} do not converge"


def manoeuvre(force: float) -> list[Phase]:
    """Drive, coast, brake."""
    return [Phase(force, DRIVE), Phase(0.0, COAST), Phase(-force, BRAKE)]


def compare(coarse: Trace, fine: Trace) -> Disagreement | None:
    """Where two drives through the same forces leave each other, worst of all; None: nowhere.

    First order passes: a finer run may differ by what one step changes, and by 5 %.
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


def goes_the_wrong_way(trace: Trace) -> bool:
    """Whether a force forwards slows a vehicle down, and more so than none or one backwards.

    A vehicle whose signs are right gains by driving, even where a slope or a slow actuator lets it
    lose speed all the same.

    Args:
        trace: of the :func:`manoeuvre`.
    """
    change = np.diff(trace.speed) / trace.step_size
    driven, braked = change[trace.force > 0.0], change[trace.force < 0.0]
    rolling = change[trace.force == 0.0][-1]  # when a slow actuator has let go
    return bool(driven.mean() < min(0.0, rolling, braked.mean()) - _CLEARLY)


def milliseconds(step: float) -> str:
    """A step as people say it: ``50 ms``."""
    return f"{1000.0 * step:.4g} ms"


def plain(error: FmuError) -> str:
    """An error without the path that the whole message begins with."""
    text = str(error)
    head, separator, rest = text.partition(": ")
    return rest if separator and (".fmu" in head or "/" in head) else text
