"""Problems with a known probability: otbenchmark's, and counter-examples of subset simulation."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import integrate, stats

Array = NDArray[np.float64]

SIMULATED = {"RP38": 0.0080536, "RP60": 0.044795}
"""Probabilities by 4e7 runs of plain Monte Carlo, where the source's is more than three standard
errors away."""


@dataclass(frozen=True)
class Problem:
    """A problem in the space of standard normal numbers.

    Attributes:
        name: Name of the problem.
        dimension: Number of inputs.
        probability: Probability of the event by the source.
        criticality: Function from vectors (n, d) to criticality (n,); at least 0 is the event.
        misleading: Whether the source gives it as a counter-example of subset simulation.
    """

    name: str
    dimension: int
    probability: float
    criticality: Callable[[Array], Array]
    misleading: bool = False

    @cached_property
    def truth(self) -> float:
        """The probability by an integral, a formula or many runs; otherwise the source's."""
        if self.name == "RP77":
            return _rp77_probability()
        if self.name == "RP107":  # the sum of ten normal numbers beyond 5 sqrt(10)
            return float(stats.norm.sf(5.0))
        if self.dimension == 2:
            return probability_in_plane(self.criticality)
        return SIMULATED.get(self.name, self.probability)


def piecewise(u: Array) -> Array:
    """Return the criticality of RP110 of the TNO problems, example 1 of Breitung (2019)."""
    x, y = u.T
    first = np.where(x <= 3.5, 0.85 - 0.1 * x, 4.0 - x)
    second = np.where(y <= 2.0, 2.3 - y, 0.5 - 0.1 * y)
    return -np.minimum(first, second)


def metaballs(u: Array) -> Array:
    """Return the criticality of the metaballs of Breitung (2019), cited from memory."""
    x, y = u.T
    first = 30.0 / ((4.0 * (x + 2.0) ** 2 / 9.0 + y**2 / 25.0) ** 2 + 1.0)
    second = 20.0 / (((x - 2.5) ** 2 / 4.0 + (y - 0.5) ** 2 / 25.0) ** 2 + 1.0)
    return 5.0 - first - second


def himmelblau(u: Array) -> Array:
    """Return the criticality of a modified Himmelblau function, after Breitung (2019).

    The formula is cited from memory, with the threshold 95.
    """
    x, y = u.T
    first = (0.75 * x - 0.5) ** 2 / 1.81 + (0.75 * y - 1.5) / 1.81 - 11.0
    second = (0.75 * x - 1.0) / 1.81 + (0.75 * y - 0.5) ** 2 / 1.81 - 7.0
    return 95.0 - first**2 - second**2


def _rp77(u: Array) -> Array:
    x, y, z = 10.0 + 0.5 * u[:, 0], u[:, 1], 4.0 + u[:, 2]
    return -np.where(z <= 5.0, x - y - z, z - y)


def probability_in_plane(criticality: Callable[[Array], Array], points: int = 3001) -> float:
    """Return the probability of an event in the plane, by the midpoint rule within 8 deviations."""
    edges = np.linspace(-8.0, 8.0, points)
    middle = (edges[1:] + edges[:-1]) / 2.0
    mass = np.diff(stats.norm.cdf(edges))
    rows = []
    for x, share in zip(middle, mass, strict=True):
        plane = np.column_stack([np.full(len(middle), x), middle])
        rows.append(share * float(mass[criticality(plane) >= 0.0].sum()))
    return float(np.sum(rows))


def _rp77_probability() -> float:
    """Return the probability of RP77, one number of its three integrated."""

    def density(z: float) -> float:
        beyond = 10.0 - z if z <= 5.0 else z
        deviation = np.sqrt(1.25) if z <= 5.0 else 1.0
        return float(stats.norm.pdf(z, 4.0) * stats.norm.sf(beyond / deviation))

    low, _ = integrate.quad(density, -4.0, 5.0, epsabs=1e-14)
    high, _ = integrate.quad(density, 5.0, 12.0, epsabs=1e-14)
    return float(low + high)


def counter_examples() -> list[Problem]:
    """Return the published problems on which subset simulation finds the wrong region."""
    planes = {"RP110": piecewise, "metaballs": metaballs, "Himmelblau": himmelblau}
    return [
        Problem(name, 2, probability_in_plane(of), of, misleading=True)
        for name, of in planes.items()
    ]


def otbenchmark_problems() -> list[Problem]:
    """Return otbenchmark's problems; RP77 and RP110, which it cannot parse, in closed form.

    Raises:
        ImportError: otbenchmark is not installed.
    """
    import openturns as ot

    ot.ComposedDistribution = ot.JointDistribution  # otbenchmark has the name of older versions
    import otbenchmark

    found = []
    for problem in otbenchmark.ReliabilityBenchmarkProblemList():
        name = problem.getName()
        if name == "RP110":
            continue  # among the counter-examples
        event = problem.getEvent()
        inputs = event.getAntecedent().getDistribution()
        of = _rp77 if name == "RP77" else _limit_state(event, inputs)
        found.append(Problem(name, inputs.getDimension(), problem.getProbability(), of))
    return found


def _limit_state(event: Any, inputs: Any) -> Callable[[Array], Array]:
    """Return the criticality by openturns: the threshold minus the limit state."""
    transformation = inputs.getInverseIsoProbabilisticTransformation()
    function, threshold = event.getFunction(), event.getThreshold()
    assert event.getOperator().getImplementation().getClassName() in {"Less", "LessOrEqual"}

    def criticality(u: Array) -> Array:
        values: Array = threshold - np.asarray(function(transformation(u))).ravel()
        return values

    return criticality
