"""Scouts: vectors far out in every direction, which find regions that chains may miss.

Levels lead chains to the region where the criticality grows first. It need not be the region with
the largest probability (Breitung, "The geometry of limit state function graphs and subset
simulation: counterexamples", Reliability Engineering & System Safety 182, 2019). Scouts are drawn
from a wider normal distribution, and weighted by the ratio of the densities: an estimate of its
own, without levels.
"""

from dataclasses import dataclass

import numpy as np

from giveway.risk.estimators.estimate import Array

# Distance by which a scout lies further out than a usual vector, whose length is about sqrt(d).
# Beyond 4 a normal number lies with a probability of 3e-5.
_FURTHER = 4.0
_DEVIATIONS = 2.6  # Width of the scouts' interval in standard deviations: 99 %


def spread(dimension: int) -> float:
    """Return the standard deviation of the scouts' components."""
    return 1.0 + _FURTHER / float(np.sqrt(dimension))


def scouts(dimension: int, count: int, random: np.random.Generator) -> Array:
    """Return scouts (count, dimension)."""
    return spread(dimension) * random.standard_normal((count, dimension))


@dataclass(frozen=True)
class Scouted:
    """The probability by scouts alone, with an interval of 99 %; zeros without an event."""

    probability: float = 0.0
    low: float = 0.0
    high: float = 0.0
    events: int = 0

    @classmethod
    def of(cls, vectors: Array, criticality: Array) -> "Scouted":
        """Return the estimate from scouts (n, d) and their criticality (n,)."""
        met = criticality >= 0.0
        if not met.any():
            return cls()
        dimension, sigma = vectors.shape[1], spread(vectors.shape[1])
        squares = np.einsum("ij,ij->i", vectors, vectors)
        weights = np.exp(dimension * np.log(sigma) - squares * (1.0 - sigma**-2) / 2.0) * met
        mean = float(weights.mean())
        scatter = float(weights.std(ddof=1)) / np.sqrt(len(weights)) / mean if mean else np.inf
        factor = float(np.exp(_DEVIATIONS * scatter))
        return cls(mean, mean / factor, mean * factor, int(np.count_nonzero(met)))
