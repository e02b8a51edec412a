"""Plain Monte Carlo, with the interval of Clopper and Pearson."""

import numpy as np
import scipy  # scipy.stats is loaded where it is first used

from giveway.risk.estimators.estimate import Array, Estimate, EventSample, Sampler

BATCH = 10_000  # Largest number of vectors in memory


def monte_carlo(
    dimension: int, runs: int, random: np.random.Generator, confidence: float = 0.95
) -> Sampler:
    """Estimate the probability from independent runs.

    The first runs of a larger sample are those of a smaller one. Runs without a result count as
    events in the upper bound and as none in the lower one.

    Args:
        dimension: Number of components of a vector.
        runs: Number of runs.
        random: Generator of the vectors.
        confidence: Confidence of the interval.
    """
    events = failed = 0
    met: list[Array] = []
    for first in range(0, runs, BATCH):
        size = min(BATCH, runs - first)
        vectors = random.standard_normal((size, dimension))
        criticality = yield vectors
        met.append(vectors[criticality >= 0.0])
        events += int(np.count_nonzero(criticality >= 0.0))
        failed += int(np.count_nonzero(np.isnan(criticality)))
    low, _ = clopper_pearson(events, runs, confidence)
    _, high = clopper_pearson(events + failed, runs, confidence)
    sample = EventSample(np.concatenate(met), np.ones(events), np.arange(events))
    found = sample if events else None
    return Estimate(events / runs, low, high, runs, events, failed, sample=found)


def clopper_pearson(events: int, runs: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the interval of a probability (Clopper & Pearson 1934).

    Without an event the upper bound is one-sided: about 3/n at 95 %.

    Args:
        events: Number of runs with the event.
        runs: Number of runs.
        confidence: Confidence of the interval.
    """
    if not events:
        return 0.0, float(1.0 - (1.0 - confidence) ** (1.0 / runs))
    tail = (1.0 - confidence) / 2.0
    low = scipy.stats.beta.ppf(tail, events, runs - events + 1)
    high = scipy.stats.beta.ppf(1.0 - tail, events + 1, runs - events) if events < runs else 1.0
    return float(low), float(high)
