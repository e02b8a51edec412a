"""The largest forces that a vehicle carries out."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fmus.checking.actuator import mean_force
from fmus.checking.fitting import STANDSTILL, Fit, fit, prepare

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fmus.checking.manoeuvres import Trace

SATURATED = 0.85  # less of the force than this share arrives: the actuator is at its limit
SHORTEST = 0.3  # [s] of a phase from which a force is read


def force_limits(tests: Sequence[Sequence[Trace]]) -> tuple[float, float]:
    """Largest drive and brake force that arrive [N]; infinite where that was not reached.

    Level by level: what the weaker ones say about M and alpha predicts the next.

    Args:
        tests: by level of force, from weak to strong.
    """
    limits = [np.inf, np.inf]
    for weaker, group in zip(range(1, len(tests)), tests[1:], strict=True):
        known = [prepare(trace, (limits[0], limits[1])) for g in tests[:weaker] for trace in g]
        model = fit(known)
        for side, sign in ((0, 1.0), (1, -1.0)):
            if model is not None and not np.isfinite(limits[side]):
                limits[side] = saturation(group, sign, model)
    return limits[0], limits[1]


def saturation(traces: Sequence[Trace], sign: float, model: Fit) -> float:
    """The smallest force [N] of one sign that falls short of the model, or infinity."""
    found = [
        arrives
        for trace in traces
        for should, arrives in arriving(trace, sign, model)
        if arrives < SATURATED * should
    ]
    return max(min(found), 0.0) if found else np.inf


def arriving(trace: Trace, sign: float, model: Fit) -> list[tuple[float, float]]:
    """Force that should act and that does [N], of the later half of each phase of one sign."""
    h = trace.step_size
    edges = np.flatnonzero(np.diff(trace.force)) + 1
    should = mean_force(trace.force, h, model.lag, model.delay)
    does = model.mass * np.diff(trace.speed) / h + model.friction * trace.speed[:-1]
    pairs = []
    for begin, end in pairwise([0, *edges.tolist(), trace.force.size]):
        half = slice((begin + end + 1) // 2, end)
        moving = (trace.speed[half] > STANDSTILL).all() and trace.speed[end] > STANDSTILL
        if (end - begin) * h >= SHORTEST and sign * trace.force[begin] > 0.0 and moving:
            pairs.append((sign * float(should[half].mean()), sign * float(does[half].mean())))
    return pairs
