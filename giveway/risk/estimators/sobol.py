"""Sobol indices of groups of components: which share of the criticality's variance each explains.

The first-order index is the share that a group explains alone, the total index the share in which
it takes part at all (Saltelli et al. 2010, "Variance based sensitivity analysis of model output",
Computer Physics Communications 181; Jansen 1999).
"""

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from giveway.risk.estimators.estimate import Array

LEAST_VECTORS = 100  # Smallest number of base vectors whose indices mean something
_RESAMPLES = 500  # Number of resamples of the bootstrap behind each interval


@dataclass(frozen=True)
class SobolIndex:
    """The indices of one group, each with its interval.

    Attributes:
        group: Name of the group.
        first: First-order index; it may be slightly negative by chance.
        first_low, first_high: Its interval.
        total: Total index.
        total_low, total_high: Its interval.
        used: Number of base vectors with a result in all their runs.
    """

    group: str
    first: float
    first_low: float
    first_high: float
    total: float
    total_low: float
    total_high: float
    used: int


def sobol_indices(
    dimension: int,
    groups: Mapping[str, Sequence[int]],
    count: int,
    seed: int,
    confidence: float = 0.95,
) -> Generator[Array, Array, tuple[SobolIndex, ...]]:
    """Estimate the indices of groups from ``count`` times (groups + 2) runs.

    Args:
        dimension: Number of components of a vector.
        groups: Components of each group, by name.
        count: Number of base vectors.
        seed: Seed of the vectors.
        confidence: Confidence of the intervals.

    Returns:
        The indices of each group in order; nan if the criticality does not vary.
    """
    random = np.random.default_rng((seed, 1))
    one, other = random.standard_normal((2, count, dimension))
    mixed = []
    for components in groups.values():
        vectors = one.copy()
        vectors[:, list(components)] = other[:, list(components)]
        mixed.append(vectors)
    found = np.split((yield np.concatenate([one, other, *mixed])), len(groups) + 2)
    values = np.array(found)
    values = values[:, np.isfinite(values).all(axis=0)]
    used = values.shape[1]
    rows = [np.arange(used), *random.integers(0, max(used, 1), (_RESAMPLES, used))]
    each = np.array([_indices(values[:, row]) for row in rows])  # (resamples + 1, 2, groups)
    tail = (1.0 - confidence) / 2.0
    low, high = np.quantile(each[1:], [tail, 1.0 - tail], axis=0)
    return tuple(
        _index(name, each[0, :, number], low[:, number], high[:, number], used)
        for number, name in enumerate(groups)
    )


def _index(group: str, shares: Array, low: Array, high: Array, used: int) -> SobolIndex:
    """Return the indices of a group from first-order and total share (2,), and their bounds."""
    first, total = ((float(shares[k]), float(low[k]), float(high[k])) for k in (0, 1))
    return SobolIndex(group, *first, *total, used)


def _indices(values: Array) -> Array:
    """Return first-order and total indices (2, groups) of values (groups + 2, n)."""
    one, other, *mixed = values
    both = np.concatenate([one, other])
    variance = float(both.var()) if both.size else 0.0
    if not variance > 0.0:
        return np.full((2, len(mixed)), np.nan)
    centre = float(both.mean())
    first = [float(np.mean((other - centre) * (each - one))) / variance for each in mixed]
    total = [float(np.mean((one - each) ** 2)) / (2.0 * variance) for each in mixed]
    return np.array([first, total])
