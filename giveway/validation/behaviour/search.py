"""The search of a fit for behaviour: CMA-ES over the logarithms of parameters.

The covariance matrix adaptation evolution strategy is that of Hansen & Ostermeier (Evol. Comput. 9,
2001) in the package cmaes. It needs no derivatives, which contacts and limits do not have, and
stands the noise of the draws. The same seed asks for the same parameters, so that a journal of the
values found is enough to go on after a kill.
"""

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from giveway.errors import ConfigError, ResultsError
from giveway.geometry.kernel import Array
from giveway.validation.behaviour.objective import FAILED
from pedestrian_model import (
    LONGEST_STEP,
    ParameterError,
    PedestrianModelError,
    VciParameters,
    require_steady,
)

RANGES: Final[Mapping[str, tuple[float, float]]] = {
    "destination_gain": (40.0, 1500.0),
    "repulsion_strength": (5.0, 1500.0),
    "repulsion_distance": (0.2, 3.0),
    "navigation_strength": (5.0, 1500.0),
    "navigation_distance": (0.2, 4.0),
    "vehicle_strength": (50.0, 6000.0),
    "vehicle_decay": (0.2, 8.0),
    "vehicle_lookahead": (0.1, 4.0),
    "vehicle_nose": (0.05, 5.0),
    "vehicle_clearance": (0.02, 1.0),
    "influence_high": (210.0, 8000.0),
    "max_acceleration": (0.4, 5.0),
    "sway": (0.02, 3.0),
    "sway_time": (0.05, 5.0),
}
"""The parameters that may be fitted for behaviour, each with its range in its own unit."""
DEFAULT: Final = tuple(RANGES)
# Where a search begins unless its start is beyond: recorded people accelerate less than the
# published parameters let them, and heed a car from farther off (ours).
_AT_MOST: Final = {"max_acceleration": 1.2, "vehicle_decay": 1.3}
_AT_LEAST: Final = {
    "vehicle_strength": 1500.0,
    "influence_high": 2000.0,
    "sway": 0.3,
    "sway_time": 0.5,
}
_INSIDE = 0.1  # Distance from the ends of the ranges at the beginning, in the logarithm
_POPULATION = 14  # Number of parameter sets of a generation
_SPREAD = 0.4  # First standard deviation, in the logarithm
_AT_BOUND = 0.02  # Distance from the end of the range, in the logarithm


@dataclass(frozen=True)
class Found:
    """The result of a search.

    Attributes:
        parameters: Best parameters.
        value: Their value of the objective.
        evaluations: Evaluations of the objective.
        at_bound: Names of parameters at the end of their range.
        spread: Standard deviation, in the logarithm, of each parameter in the last generation.
    """

    parameters: VciParameters
    value: float
    evaluations: int
    at_bound: tuple[str, ...]
    spread: dict[str, float]


class Search:
    """A search for the parameters with the least value of an objective.

    Args:
        objective: Function of parameters.
        start: Start of the search; parameters that are not named stay.
        names: Names of the free parameters, of ``RANGES``.
        seed: Seed of the search. Another one begins elsewhere as well, except for 0.
        evaluations: Number of evaluations, rounded up to whole generations.

    Raises:
        ConfigError: a name cannot be fitted.
    """

    def __init__(
        self,
        objective: Callable[[VciParameters], float],
        start: VciParameters,
        names: Sequence[str] = DEFAULT,
        *,
        seed: int = 0,
        evaluations: int = 1500,
    ) -> None:
        require_fittable(names)
        self._objective, self._start, self._names = objective, start, tuple(names)
        self._seed, self._generations = seed, -(-evaluations // _POPULATION)
        self._low, self._high = np.log(np.array([RANGES[name] for name in names])).T

    @property
    def evaluations(self) -> int:
        """The number of evaluations, of whole generations."""
        return self._generations * _POPULATION

    def run(
        self,
        journal: "Journal",
        progress: Callable[[int, int, float], None] = lambda _done, _all, _best: None,
    ) -> Found:
        """Search, and return the best parameters found.

        Args:
            journal: Journal of the values; those that it has are not computed again.
            progress: Function of the evaluations done, of all, and the least value.

        Raises:
            ResultsError: the journal cannot be written.
        """
        from cmaes import CMA

        search = CMA(
            mean=self._begin(),
            sigma=_SPREAD,
            bounds=np.column_stack([self._low, self._high]),
            seed=self._seed + 1,
            population_size=_POPULATION,
        )
        best, least, done = self._begin(), math.inf, 0
        for _ in range(self._generations):
            asked: list[tuple[Array, float]] = []
            for _ in range(_POPULATION):
                x = search.ask()
                value = journal.value(done, partial(self._value, x))
                asked.append((x, value))
                done += 1
                if value < least:
                    best, least = x, value
                progress(done, self.evaluations, least)
            search.tell(asked)
        ends = np.minimum(best - self._low, self._high - best)
        last = np.std([x for x, _ in asked], axis=0)
        return Found(
            self._parameters(best),
            least,
            done,
            tuple(n for n, end in zip(self._names, ends, strict=True) if end < _AT_BOUND),
            {n: float(each) for n, each in zip(self._names, last, strict=True)},
        )

    def _begin(self) -> Array:
        begun = asdict(self._start)
        begun |= {name: min(begun[name], value) for name, value in _AT_MOST.items()}
        begun |= {name: max(begun[name], value) for name, value in _AT_LEAST.items()}
        begin = np.log([begun[name] or RANGES[name][0] for name in self._names])
        if self._seed:
            begin = begin + np.random.default_rng(self._seed).normal(0.0, _SPREAD, len(begin))
        return np.asarray(np.clip(begin, self._low + _INSIDE, self._high - _INSIDE))

    def _parameters(self, x: Array) -> VciParameters:
        values = np.exp(np.clip(x, self._low, self._high))
        return replace(
            self._start, **{n: float(v) for n, v in zip(self._names, values, strict=True)}
        )

    def _value(self, x: Array) -> float:
        try:
            parameters = self._parameters(x)
            require_steady(parameters, LONGEST_STEP)
            return self._objective(parameters)
        except (ParameterError, PedestrianModelError):
            return FAILED


def require_fittable(names: Sequence[str]) -> None:
    """Make sure that each of ``names`` is a parameter that may be fitted for behaviour.

    Raises:
        ConfigError: one is not.
    """
    for name in names:
        if name not in RANGES or names.count(name) > 1:
            raise ConfigError(
                f"--parameters {name}: cannot be fitted for behaviour; expected, once each, of "
                f"{', '.join(RANGES)}"
            )


class Journal:
    """The values of a search in a file, one a line after a line that says what was searched.

    Args:
        file: File, or None to keep nothing.
        settings: What the values depend on; a file that was begun with other settings is begun
            again.

    Raises:
        ResultsError: the file cannot be read or written.
    """

    def __init__(self, file: Path | None, settings: object) -> None:
        self._file = file
        self._values: list[float] = []
        if file is None:
            return
        head = hashlib.sha256(repr(settings).encode()).hexdigest()
        try:
            lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
            if lines and lines[0] == head:
                self._values = _whole(lines[1:])
            else:
                file.write_text(head + "\n", encoding="utf-8")
        except OSError as error:
            raise _unusable(file, error) from error

    @property
    def known(self) -> int:
        """The number of values that are known."""
        return len(self._values)

    def value(self, number: int, compute: Callable[[], float]) -> float:
        """Return a value, computed and written unless it is known.

        Args:
            number: Number of the evaluation, from 0 on without gaps.
            compute: Function that computes it.

        Raises:
            ResultsError: the file cannot be written.
        """
        if number < len(self._values):
            return self._values[number]
        self._values.append(compute())
        if self._file is not None:
            try:
                with self._file.open("a", encoding="utf-8") as file:
                    file.write(f"{self._values[-1]!r}\n")
            except OSError as error:
                raise _unusable(self._file, error) from error
        return self._values[-1]


def _whole(lines: list[str]) -> list[float]:
    """Return the values up to the first line that a kill cut off."""
    values = []
    for line in lines:
        try:
            values.append(float(line))
        except ValueError:
            break
    return values


def _unusable(file: Path, error: OSError) -> ResultsError:
    return ResultsError(
        f"{file}: the journal of the fit cannot be used ({error.strerror}); "
        "name another file with --out"
    )
