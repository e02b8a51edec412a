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

from fmus.checking.manoeuvres import Phase, Trace, drive
from fmus.errors import (
    FmuCrashError,
    FmuError,
    FmuInterfaceError,
    FmuOutputError,
    FmuProfileError,
    FmuStartError,
    FmuStepError,
)

if TYPE_CHECKING:
    from pathlib import Path

    from fmus.checking.manoeuvres import Opener

DIVISORS = (1, 2, 5, 10, 20, 50, 100)  # of the step; what is tried, coarse to fine
RELATIVE = 0.05  # of the largest speed or way of the finer run
SPEED_FLOOR = 0.05  # [m/s]
POSITION_FLOOR = 0.05  # [m]
LARGEST_ACCELERATION = 15.0  # [m/s2] of a road vehicle; what one step may change
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
        FmuError: the FMU fails at every step.
    """
    rung = _Rungs(opener, fmu_step, force, start_speed)
    if isinstance(rung.run(1), _UNABLE):
        raise rung.failure(1)
    finer = rung.next_finer(1)
    if isinstance(rung.run(1), FmuError) and finer is None:
        raise rung.failure(1)
    if finer is None:
        return Convergence(fmu_step, None, traces=rung.shown(1))
    problem = rung.problem(1, finer)
    shown = rung.shown(1) + rung.shown(finer)
    if not problem:
        return Convergence(fmu_step, fmu_step / finer, traces=shown)
    advised = rung.first_converged()
    if advised is None and isinstance(rung.run(1), FmuError):
        raise rung.failure(1)
    return Convergence(
        fmu_step, fmu_step / finer, problem, None if advised is None else fmu_step / advised, shown
    )


class _Rungs:
    """The ladder of steps; each is run once, when it is asked for."""

    def __init__(self, opener: Opener, step: float, force: float, start_speed: float) -> None:
        self._opener = opener
        self._step = step
        self._force = force
        self._speeds = sorted({0.0, start_speed}, reverse=True)
        self._runs: dict[int, list[Trace] | FmuError] = {}

    def run(self, divisor: int) -> list[Trace] | FmuError:
        if divisor not in self._runs:
            self._runs[divisor] = self._attempt(divisor)
        return self._runs[divisor]

    def failure(self, divisor: int) -> FmuError:
        found = self.run(divisor)
        assert isinstance(found, FmuError)
        return found

    def shown(self, divisor: int) -> tuple[Trace, ...]:
        found = self.run(divisor)
        return () if isinstance(found, FmuError) else (found[0],)

    def next_finer(self, divisor: int) -> int | None:
        """The next rung that the FMU can do: some refuse steps that are not theirs."""
        for finer in DIVISORS:
            if finer > divisor and not isinstance(self.run(finer), FmuError):
                return finer
        return None

    def problem(self, coarse: int, fine: int) -> str:
        """Why the coarse step will not do; empty if it will."""
        here, there = self.run(coarse), self.run(fine)
        name = f"its steps of {milliseconds(self._step / coarse)} do not converge"
        if isinstance(here, FmuError):
            return f"{name} ({plain(here)})"
        other = milliseconds(self._step / fine)
        assert not isinstance(there, FmuError)
        for one, two in zip(here, there, strict=True):
            found = compare(one, two)
            if found:
                return (
                    f"{name}: {found.quantity} {found.coarse:.3g} {found.unit} at "
                    f"{found.time:.3g} s, {found.fine:.3g} {found.unit} with {other}"
                )
        return ""

    def first_converged(self) -> int | None:
        """The coarsest of the finer rungs that agrees with the one below it."""
        able = [rung for rung in DIVISORS[1:] if not isinstance(self.run(rung), FmuError)]
        for coarse, fine in pairwise(able):
            if not self.problem(coarse, fine):
                return coarse
        return None

    def _attempt(self, divisor: int) -> list[Trace] | FmuError:
        step = None if divisor == 1 else self._step / divisor
        try:
            return [
                drive(self._opener, manoeuvre(self._force), speed=speed, fmu_step=step)
                for speed in self._speeds
            ]
        except FmuCrashError:
            raise  # a dead process says nothing about steps, and a hang costs minutes
        except (FmuOutputError, FmuStepError, *_UNABLE) as error:
            return error


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


def milliseconds(step: float) -> str:
    """A step as people say it: ``50 ms``."""
    return f"{1000.0 * step:.4g} ms"


def plain(error: FmuError) -> str:
    """An error without the path that the whole message begins with."""
    text = str(error)
    head, separator, rest = text.partition(": ")
    return rest if separator and (".fmu" in head or "/" in head) else text
