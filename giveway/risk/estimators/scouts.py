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
# Effective sample size of the events below which a few weights decide, and the interval is wrong.
# In 10 dimensions 600 scouts of an event of 2e-3 had 22 events that were worth 2.5
_LEAST_SIZE = 10.0


def spread(dimension: int) -> float:
    """Return the standard deviation of the scouts' components."""
    return 1.0 + _FURTHER / float(np.sqrt(dimension))


def scouts(dimension: int, count: int, random: np.random.Generator) -> Array:
    """Return scouts (count, dimension)."""
    return spread(dimension) * random.standard_normal((count, dimension))


@dataclass(frozen=True)
class Scouted:
    """The probability by scouts alone, with an interval of 99 %; zeros where they see nothing.

    They see nothing without an event, and where a few weights decide, as in many dimensions.
    """

    probability: float = 0.0
    low: float = 0.0
    high: float = 0.0
    events: int = 0

    @classmethod
    def of(cls, vectors: Array, criticality: Array) -> "Scouted":
        """Return the estimate from scouts (n, d) and their criticality (n,)."""
        met = criticality >= 0.0
        events = int(np.count_nonzero(met))
        dimension, sigma = vectors.shape[1], spread(vectors.shape[1])
        squares = np.einsum("ij,ij->i", vectors, vectors)
        weights = np.exp(dimension * np.log(sigma) - squares * (1.0 - sigma**-2) / 2.0) * met
        total, squared = float(weights.sum()), float(np.sum(weights**2))
        if total**2 < max(_LEAST_SIZE * squared, np.finfo(float).tiny):
            return cls(events=events)
        mean = total / len(weights)
        factor = float(np.exp(_DEVIATIONS * weights.std(ddof=1) / np.sqrt(len(weights)) / mean))
        return cls(mean, mean / factor, mean * factor, events)
