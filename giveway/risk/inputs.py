"""The random inputs of a run: one vector of standard normal numbers becomes its settings.

The first component is the seed, which draws everything that has no component of its own. The next
ones are the declared inputs, each by its quantile function, and the last ones place people.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, ndtr, ndtri

from giveway.config import RunConfig
from giveway.config.files.layers import undotted
from giveway.config.tables.crowd import DRAWS_PER_PERSON, ENCOUNTERS
from giveway.errors import ConfigError, suggestion

CROWD = "crowd"  # Name of the input that places people by components of their own
SEED = 0  # Component of the seed
INJURY = "injury"  # Name of the draw whether a contact injures
NOISE = "noise"  # Name of what the seed draws
_SEEDS = 2**31 - 1  # Number of seeds
_NUMBERS = {
    "normal": ("mean", "deviation"),
    "truncated-normal": ("mean", "deviation", "low", "high"),
    "lognormal": ("median", "deviation of the logarithm"),
    "uniform": ("low", "high"),
    "triangular": ("low", "mode", "high"),
    "exponential": ("mean",),
}
"""Names of each distribution's numbers."""
CHOICE = "choice"


@dataclass(frozen=True)
class RandomInput:
    """One option of the run that is random.

    Attributes:
        name: Name of the option, as ``vehicle.mass``.
        distribution: Name of the distribution.
        numbers: Numbers of the distribution, or the values of a choice.
    """

    name: str
    distribution: str
    numbers: tuple[Any, ...]

    def value(self, component: float) -> Any:
        """Return the option's value for one component of the vector."""
        share = float(ndtr(component))
        if self.distribution == CHOICE:
            return self.numbers[min(int(share * len(self.numbers)), len(self.numbers) - 1)]
        first, *rest = self.numbers
        match self.distribution:
            case "normal":
                return first + rest[0] * component
            case "truncated-normal":
                return _truncated(share, first, *rest)
            case "lognormal":
                return first * float(np.exp(rest[0] * component))
            case "uniform":
                return first + (rest[0] - first) * share
            case "triangular":
                return _triangular(share, first, *rest)
            case _:
                return -first * float(log_ndtr(-component))


def _truncated(share: float, mean: float, deviation: float, low: float, high: float) -> float:
    """Return a quantile of a normal distribution between two bounds."""
    least, most = ndtr((low - mean) / deviation), ndtr((high - mean) / deviation)
    value = mean + deviation * float(ndtri(least + share * (most - least)))
    return min(max(value, low), high)


def _triangular(share: float, low: float, mode: float, high: float) -> float:
    """Return a quantile of a triangular distribution."""
    if share * (high - low) < mode - low:
        return low + math.sqrt(share * (high - low) * (mode - low))
    return high - math.sqrt((1.0 - share) * (high - low) * (high - mode))


@dataclass(frozen=True)
class RandomInputs:
    """All random inputs of a run.

    Attributes:
        scalars: Options that are random.
        people: Number of people who are placed by components of their own; 0: the seed does.
        draws_injury: Whether the last component draws whether a contact injures.
    """

    scalars: tuple[RandomInput, ...]
    people: int
    draws_injury: bool = False

    @property
    def dimension(self) -> int:
        """The number of components of the vector."""
        return self._end_of_people + self.draws_injury

    @property
    def _end_of_people(self) -> int:
        return 1 + len(self.scalars) + DRAWS_PER_PERSON * self.people

    @property
    def groups(self) -> dict[str, list[int]]:
        """The components of each purpose: the noise by the seed, each input, the people."""
        scalars = {one.name: [1 + number] for number, one in enumerate(self.scalars)}
        people = list(range(1 + len(self.scalars), self._end_of_people))
        injury = list(range(self._end_of_people, self.dimension))
        placed = {name: found for name, found in ((CROWD, people), (INJURY, injury)) if found}
        return {NOISE: [SEED], **scalars, **placed}

    def injury_draw(self, vector: NDArray[np.float64]) -> float:
        """Return the uniform number that draws the injury of a vector (dimension,), or nan."""
        return float(ndtr(vector[-1])) if self.draws_injury else math.nan

    def settings(self, vector: NDArray[np.float64]) -> dict[str, Any]:
        """Return the settings of the run that a vector (dimension,) makes."""
        seed = 1 + min(int(float(ndtr(vector[SEED])) * _SEEDS), _SEEDS - 1)
        values = {"seed": seed, **self.values(vector)}
        if self.people:
            values["crowd.draws"] = vector[1 + len(self.scalars) : self._end_of_people].tolist()
        return undotted(values)

    def values(self, vector: NDArray[np.float64]) -> dict[str, Any]:
        """Return the value of each declared input for a vector (dimension,)."""
        components = vector[1 : 1 + len(self.scalars)]
        return {
            one.name: one.value(float(component))
            for one, component in zip(self.scalars, components, strict=True)
        }


def read_inputs(declared: Mapping[str, Any], origin: str) -> tuple[RandomInput, ...]:
    """Return the declared inputs, ``crowd`` left out.

    Args:
        declared: Table like ``{"vehicle.mass": {"normal": [1000, 100]}}``.
        origin: Origin of the table, for messages.

    Raises:
        ConfigError: a distribution or its numbers cannot be used.
    """
    return tuple(
        _read(f"{origin}: [inputs] {name}", str(name), given)
        for name, given in declared.items()
        if name != CROWD
    )


def _read(where: str, name: str, given: Any) -> RandomInput:
    if not isinstance(given, Mapping) or len(given) != 1:
        raise ConfigError(
            f"{where} = {given!r}: expected one distribution and its numbers, like "
            "{ normal = [1000, 100] }"
        )
    ((distribution, numbers),) = given.items()
    values = (
        tuple(numbers)
        if isinstance(numbers, Sequence) and not isinstance(numbers, str)
        else (numbers,)
    )
    if distribution == CHOICE:
        if len(values) < 2:
            raise ConfigError(f"{where}: choice = {list(values)}: expected two values or more")
        return RandomInput(name, distribution, values)
    if distribution not in _NUMBERS:
        known = [*_NUMBERS, CHOICE]
        hint = suggestion(str(distribution), known, f"expected one of {', '.join(known)}")
        raise ConfigError(f"{where}: no distribution is called '{distribution}'; {hint}")
    expected = _NUMBERS[distribution]
    numeric = all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)
    if len(values) != len(expected) or not numeric:
        raise ConfigError(
            f"{where}: {distribution} = {list(values)}: expected {len(expected)} numbers: "
            f"{', '.join(expected)}"
        )
    one = RandomInput(name, distribution, values)
    _require_sound(where, one)
    return one


def _require_sound(where: str, one: RandomInput) -> None:
    """Make sure that the numbers of a distribution have one.

    Raises:
        ConfigError: a deviation is not above 0, or bounds are not in order.
    """
    numbers = dict(zip(_NUMBERS[one.distribution], one.numbers, strict=True))
    low, high = numbers.get("low", -math.inf), numbers.get("high", math.inf)
    ordered = low < high and low <= numbers.get("mode", low) <= high
    positive = all(
        value > 0.0 for name, value in numbers.items() if name.startswith(("deviation", "median"))
    )
    if not (ordered and positive and all(map(math.isfinite, one.numbers))):
        raise ConfigError(
            f"{where}: {one.distribution} = {list(one.numbers)}: expected deviations above 0 and "
            "low < high"
        )


def people_placed(config: RunConfig, wanted: Any, origin: str) -> int:
    """Return the number of people that have components of their own.

    Args:
        config: Configuration of the runs.
        wanted: Value of ``crowd`` in the inputs, or None if it is not declared.
        origin: Origin of the inputs, for messages.

    Raises:
        ConfigError: ``crowd`` cannot be used.
    """
    possible = config.crowd.pedestrians > 0 and config.crowd.sampler != ENCOUNTERS
    if not (wanted is None or isinstance(wanted, bool)):
        raise ConfigError(f"{origin}: [inputs] crowd = {wanted!r}: expected true or false")
    if wanted and not possible:
        raise ConfigError(
            f"{origin}: [inputs] crowd = true: nobody can be placed: expected crowd.pedestrians "
            "above 0 and crowd.sampler = 'area'; without it the seed places people"
        )
    return config.crowd.pedestrians if possible and wanted is not False else 0
