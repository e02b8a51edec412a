"""The largest forces that a vehicle can produce."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fmus.checking.manoeuvres import Trace
from fmus.checking.model_fit.actuator import mean_force
from fmus.checking.model_fit.fitting import (
    STANDSTILL,
    Drive,
    Fit,
    least_squares,
    resistance_rows,
)

SATURATED = 0.85  # share of the force below which the actuator is at its limit
_ENOUGH = 20  # steps needed for four coefficients
BEYOND = 1.5  # Factor by which the force at another time must exceed a limit to disprove it
SHORTEST = 0.3  # [s] shortest phase from which a force is read


@dataclass(frozen=True)
class ResistanceModel:
    """M v' + alpha v + c_0 + c_2 v |v| = F: the resistance of a vehicle that rolls forwards.

    With M and alpha alone, a truck's rolling resistance would look like a saturated drive.
    """

    mass: float  # M [kg]
    friction: float  # alpha [N.s/m]
    constant: float  # c_0 [N]
    quadratic: float  # c_2 [N.s2/m2]
    lag: float  # [s]
    delay: float  # [s]

    @classmethod
    def of(cls, model: Fit, drives: Sequence[Drive]) -> Self:
        """Fit all four coefficients by least squares, with the actuator of ``model``."""
        plain = cls(model.mass, model.friction, 0.0, 0.0, model.lag, model.delay)
        rows, measured = resistance_rows(drives, model.lag, model.delay)
        if measured.size < _ENOUGH:
            return plain
        solution, scale = least_squares(rows, measured)
        inverse, *resistance = (solution / scale).tolist()
        if inverse <= 0.0:
            return plain
        alpha, c_0, c_2 = (share / inverse for share in resistance)
        return cls(1.0 / inverse, alpha, c_0, c_2, model.lag, model.delay)

    def force(
        self, speed: NDArray[np.float64], acceleration: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return the force [N] that must act for this motion."""
        drag = self.friction * speed + self.constant + self.quadratic * speed * np.abs(speed)
        return self.mass * acceleration + drag


def saturation(
    traces: Sequence[Trace], sign: float, model: ResistanceModel, weaker: Sequence[Trace] = ()
) -> float:
    """Return the smallest force [N] of one sign that falls short of the model, or infinity.

    Args:
        traces: Traces of the forces in question.
        sign: Sign of the forces that count.
        model: Model of the vehicle.
        weaker: Traces of the same tests with less force. There is no limit if more force arrives
            with a larger command, as in a higher gear.
    """
    lesser = [arriving(trace, sign, model) for trace in weaker] or [[] for _ in traces]
    found = [
        arrives
        for trace, before in zip(traces, lesser, strict=True)
        for should, arrives in arriving(trace, sign, model)
        if arrives < SATURATED * should and not _grows(should, arrives, before)
    ]
    return max(min(found), 0.0) if found else np.inf


def _grows(should: float, arrives: float, before: Sequence[tuple[float, float]]) -> bool:
    """Return whether the arriving force has grown as much as the commanded force."""
    if not before or not 0.0 < before[-1][0] < should or before[-1][1] <= 0.0:
        return False
    return arrives / before[-1][1] >= SATURATED * should / before[-1][0]


def arriving(trace: Trace, sign: float, model: ResistanceModel) -> list[tuple[float, float]]:
    """Return pairs of the expected and the arriving force [N] for each phase of one sign.

    The later half of a phase counts.
    """
    h = trace.step_size
    edges = np.flatnonzero(np.diff(trace.force)) + 1
    should = mean_force(trace.force, h, model.lag, model.delay)
    does = model.force(trace.speed[:-1], np.diff(trace.speed) / h)
    pairs = []
    for begin, end in pairwise([0, *edges.tolist(), trace.force.size]):
        half = slice((begin + end + 1) // 2, end)
        moving = (trace.speed[half] > STANDSTILL).all() and trace.speed[end] > STANDSTILL
        if (end - begin) * h >= SHORTEST and sign * trace.force[begin] > 0.0 and moving:
            pairs.append((sign * float(should[half].mean()), sign * float(does[half].mean())))
    return pairs
