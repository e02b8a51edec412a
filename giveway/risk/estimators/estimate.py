"""An estimated probability, its interval, and the reasons to doubt it."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stage:
    """One stage of an estimate: a level of a repeat, or a batch.

    Attributes:
        repeat: Number of the repeat, from 1.
        stage: Number of the stage within the repeat, from 1.
        runs: Number of runs of the stage.
        level: Criticality that the next stage exceeds; 0 is the event.
        share: Share of the runs beyond the level.
        step: Size of the chains' steps, from 0 to 1; 0 without chains.
        accepted: Share of the chains' proposals that were accepted; 1 without chains.
        probability: Probability to be beyond the level, by this repeat.
    """

    repeat: int
    stage: int
    runs: int
    level: float
    share: float
    step: float
    accepted: float
    probability: float


@dataclass(frozen=True)
class EventSample:
    """Vectors that are distributed as the inputs given the event.

    Attributes:
        vectors: Vectors (n, d); those of a chain may repeat.
        weights: Weight (n,) of each, in any unit.
        sources: Number (n,) of the independent source of each: a run, or a repeat with its chains.
    """

    vectors: Array
    weights: Array
    sources: NDArray[np.int64]


@dataclass(frozen=True)
class Estimate:
    """The probability of the event in one run.

    Attributes:
        probability: Estimate; 0 if the event was never met.
        low: Lower bound of the interval; 0 if the event was never met.
        high: Upper bound of the interval; one-sided if the event was never met.
        runs: Number of runs that were used.
        events: Number of runs in which the event happened.
        failed: Number of runs without a result.
        doubts: Reasons for which the interval may not hold, each a sentence; empty if none is
            known.
        stages: Stages of the estimate in their order.
        sample: Vectors given the event, or None without one.
    """

    probability: float
    low: float
    high: float
    runs: int
    events: int
    failed: int
    doubts: tuple[str, ...] = ()
    stages: tuple[Stage, ...] = ()
    sample: EventSample | None = field(default=None, compare=False, repr=False)


Sampler = Generator[Array, Array, Estimate]
"""An estimator at work, as described in the package."""


def run_sampler(sampler: Sampler, criticality: Callable[[Array], Array]) -> Estimate:
    """Return the estimate for a criticality that is computed in this process.

    Args:
        sampler: Estimator.
        criticality: Function from vectors (n, d) to criticality (n,).
    """
    try:
        vectors = next(sampler)
        while True:
            vectors = sampler.send(criticality(vectors))
    except StopIteration as end:
        estimate: Estimate = end.value
        return estimate
