"""The fit: the smallest displacement error over some of the parameters.

The objective is the ADE [m] at each horizon, averaged over all pedestrians who are seen for that
long, and then over the horizons. It is minimised by the simplex method of Nelder & Mead (The
Computer Journal 1965) as in scipy, with the coefficients of Gao & Han (Comput. Optim. Appl. 2012),
over the logarithm of each parameter's ratio to its start. Parameters with which people would
tremble at the crowd's longest step are refused. The method needs no derivatives, which would not
exist at contacts and limits, and it stays near the published numbers.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import scipy

from giveway.geometry.kernel import Array
from giveway.validation.evaluation import displacement
from giveway.validation.predictors import VciPredictor
from giveway.validation.protocol import Protocol, Window
from pedestrian_model import (
    LONGEST_STEP,
    ParameterError,
    PedestrianModelError,
    VciParameters,
    require_steady,
)

FACTOR = 10.0  # Factor by which parameters may differ from their start
_SPREAD = 0.2  # Size of the first simplex, in the logarithm
_SMALL = 0.02  # Size of the simplex at which the search ends, in the logarithm
_FLAT = 5e-5  # Difference [m] of the errors at its corners below which it ends
_AT_BOUND = 1e-3  # Distance, in the logarithm, below which a parameter is at its bound


class Objective:
    """The mean displacement error [m] of parameters over windows.

    Args:
        cut: Windows, at least one.
        protocol: Protocol by which the windows were cut.
        clips: Number of clips.
        own_pace: Flag, see :class:`VciPredictor`.
    """

    def __init__(
        self, cut: Sequence[Window], protocol: Protocol, clips: int, *, own_pace: bool = True
    ) -> None:
        self._cut, self._protocol, self._clips = cut, protocol, clips
        self._own_pace = own_pace
        self._steps = np.array(protocol.horizons) - 1

    def __call__(self, parameters: VciParameters) -> float:
        """Return the error; infinite if the model fails with these parameters."""
        try:
            total, count = self.per_clip(parameters)
        except PedestrianModelError:
            return math.inf
        return average(total, count)

    def per_clip(self, parameters: VciParameters) -> tuple[Array, Array]:
        """Return sums and numbers (C, K) of the ADE in each clip at each horizon."""
        shape = self._clips, len(self._steps)
        total, count = np.zeros(shape), np.zeros(shape)
        predict = VciPredictor(
            parameters, self._protocol.time_step, self._protocol.longest, own_pace=self._own_pace
        )
        for window in self._cut:
            error = displacement(predict(window), window)
            ade = np.cumsum(error, axis=0)[self._steps] / (self._steps + 1.0)[:, None]
            total[window.clip] += np.nansum(ade, axis=1)
            count[window.clip] += (~np.isnan(ade)).sum(axis=1)
        return total, count


def average(total: Array, count: Array) -> float:
    """Return the objective from sums and counts (C, K): the mean of the means at each horizon."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nanmean(total.sum(axis=0) / count.sum(axis=0)))


class Search:
    """A search for the smallest error, from ``start``.

    Args:
        objective: Objective to minimise.
        start: Start of the search; parameters that are not named stay.
        names: Names of the free parameters; none may start at 0.
        evaluations: Largest number of evaluations of the objective.
        progress: Function of the evaluations done, their limit, and the smallest error so far.
    """

    def __init__(
        self,
        objective: Objective,
        start: VciParameters,
        names: Sequence[str],
        evaluations: int,
        progress: Callable[[int, int, float], None],
    ) -> None:
        self._objective, self._start, self._names = objective, start, tuple(names)
        self._most, self._progress = evaluations, progress
        self._least = math.inf
        self.done = 0
        self.converged = False
        self.at_bound: tuple[str, ...] = ()

    def run(self) -> VciParameters:
        """Return the best parameters found, which are never worse than the start."""
        n, bound = len(self._names), math.log(FACTOR)
        simplex = np.vstack([np.zeros(n), _SPREAD * np.eye(n)])
        found = scipy.optimize.minimize(
            self._error,
            np.zeros(n),
            method="Nelder-Mead",
            bounds=[(-bound, bound)] * n,
            options={
                "initial_simplex": simplex,
                "maxfev": self._most,
                "xatol": _SMALL,
                "fatol": _FLAT,
                "adaptive": True,
            },
        )
        self.converged = bool(found.success)
        self.at_bound = tuple(
            name for name, x in zip(self._names, found.x, strict=True) if abs(x) > bound - _AT_BOUND
        )
        return self._parameters(found.x)

    def _parameters(self, x: Array) -> VciParameters:
        factors = dict(zip(self._names, np.exp(x), strict=True))
        return replace(
            self._start,
            **{name: float(getattr(self._start, name) * by) for name, by in factors.items()},
        )

    def _error(self, x: Array) -> float:
        try:
            parameters = self._parameters(x)
            require_steady(parameters, LONGEST_STEP)  # a camera's frames are shorter than that
            error = self._objective(parameters)
        except ParameterError:  # the parameters are beyond the model's own bounds
            error = math.inf
        self.done += 1
        self._least = min(self._least, error)
        self._progress(self.done, self._most, self._least)
        return error
