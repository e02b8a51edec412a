"""Importance sampling from a mixture that the cross-entropy method finds.

Stages move a mixture of normal distributions towards the event (Rubinstein & Kroese 2017; Geyer,
Papaioannou & Straub 2019). Then the mixture is frozen, and the estimate comes from fresh runs
alone, so that it is unbiased. A tenth of the mixture is the distribution of the inputs, which
bounds the weights by ten (Hesterberg 1995, a defensive mixture); another tenth are scouts.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy  # scipy.stats is loaded where it is first used
from scipy.special import logsumexp

from giveway.risk.estimators.estimate import Array, Estimate, EventSample, Sampler, Stage
from giveway.risk.estimators.monte_carlo import clopper_pearson
from giveway.risk.estimators.scouts import spread

LEAST_BUDGET = 200  # Smallest budget whose stages leave half of it for the estimate
SHARE = 0.1  # Share of the runs of a stage to which the mixture is fitted
_PREPARING = 0.5  # Share of the budget for the stages
_STAGES = 10  # Largest number of stages
_DEFENSIVE, _SCOUTING = 0.1, 0.1  # Shares of the mixture
_COMPONENTS = 4  # Number of normal distributions of the mixture
_ITERATIONS = 30  # Rounds of expectation and maximisation
_LEAST_VARIANCE = 1e-3  # Added to each variance, so that no component shrinks to a point
# Factor on the fitted deviations: fitted to few vectors, they leave the event's borders out
_WIDER = 1.2
_LEAST_SIZE = 50.0  # Effective sample size of the events below which the estimate is in doubt
_HEAVY = 0.7  # Shape of the weights' tail above which their mean is in doubt (Vehtari et al. 2024)
_TAIL = 0.2  # Share of the events' weights that is their tail


@dataclass
class Mixture:
    """A mixture of the inputs' distribution, of scouts, and of fitted normal distributions.

    Attributes:
        dimension: Number of components of a vector.
        shares: Share (k,) of each fitted distribution; their sum is 1.
        means: Means (k, d).
        roots: Lower Cholesky factors (k, d, d) of the covariances.
    """

    dimension: int
    shares: Array = field(default_factory=lambda: np.empty(0))
    means: Array = field(default_factory=lambda: np.empty((0, 0)))
    roots: Array = field(default_factory=lambda: np.empty((0, 0, 0)))

    def _parts(self) -> Array:
        """Return the share of each part: inputs, scouts, fitted distributions."""
        if not len(self.shares):
            return np.array([0.5, 0.5])
        fitted = (1.0 - _DEFENSIVE - _SCOUTING) * self.shares
        return np.array([_DEFENSIVE, _SCOUTING, *fitted])

    def draw(self, count: int, random: np.random.Generator) -> Array:
        """Return vectors (count, d)."""
        parts = random.choice(len(self._parts()), count, p=self._parts())
        normal = random.standard_normal((count, self.dimension))
        normal[parts == 1] *= spread(self.dimension)
        for number, (mean, root) in enumerate(zip(self.means, self.roots, strict=True)):
            mine = parts == number + 2
            normal[mine] = mean + normal[mine] @ root.T
        return normal

    def log_weights(self, vectors: Array) -> Array:
        """Return the logarithm (n,) of the inputs' density over the mixture's."""
        plain = _log_normal(np.einsum("ij,ij->i", vectors, vectors), self.dimension, 0.0)
        sigma = spread(self.dimension)
        wide = _log_normal(
            np.einsum("ij,ij->i", vectors, vectors) / sigma**2,
            self.dimension,
            self.dimension * np.log(sigma),
        )
        densities = np.column_stack([plain, wide, *self.log_densities(vectors)])
        weights: Array = plain - logsumexp(densities, b=self._parts(), axis=1)
        return weights

    def log_densities(self, vectors: Array) -> list[Array]:
        """Return the logarithmic density (n,) of each fitted distribution."""
        return [
            _log_normal(
                np.sum(np.linalg.solve(root, (vectors - mean).T) ** 2, axis=0),
                self.dimension,
                float(np.log(np.diag(root)).sum()),
            )
            for mean, root in zip(self.means, self.roots, strict=True)
        ]


def _log_normal(squares: Array, dimension: int, log_determinant: float) -> Any:
    return -0.5 * (squares + dimension * np.log(2.0 * np.pi)) - log_determinant


def importance_sampling(
    dimension: int, budget: int, seed: int, confidence: float = 0.95
) -> Sampler:
    """Estimate the probability by importance sampling from a fitted mixture.

    Args:
        dimension: Number of components of a vector.
        budget: Number of runs; half of them, at most, prepare the mixture.
        seed: Seed of the vectors.
        confidence: Confidence of the interval.
    """
    random = np.random.default_rng((seed, 0))
    size = max(10, int(_PREPARING * budget / _STAGES))
    mixture, stages, failed, used = Mixture(dimension), [], 0, 0
    reached = False
    for stage in range(1, _STAGES + 1):
        vectors = mixture.draw(size, random)
        criticality = yield vectors
        used += size
        failed += int(np.isnan(criticality).sum())
        criticality = np.where(np.isnan(criticality), -np.inf, criticality)
        logs = mixture.log_weights(vectors)
        level = min(0.0, float(np.quantile(criticality, 1.0 - SHARE)))
        beyond = criticality >= level
        mass = float(np.mean(np.exp(logs) * beyond))
        stages.append(Stage(1, stage, size, level, float(beyond.mean()), 0.0, 1.0, mass))
        if not np.isfinite(level):
            break
        mixture = _fitted(vectors[beyond], logs[beyond], random)
        if reached:
            break
        reached = level >= 0.0
    rest = budget - used
    vectors = mixture.draw(rest, random)
    criticality = yield vectors
    failed += int(np.isnan(criticality).sum())
    met = criticality >= 0.0
    weights = np.exp(mixture.log_weights(vectors)) * met
    doubts = [] if reached else ["the stages did not reach the event; raise the budget"]
    if failed:
        doubts.append(f"{failed} runs have no result, and count as runs without the event")
    probability, low, high, more = _weighted(weights, confidence)
    stages.append(Stage(1, len(stages) + 1, rest, 0.0, float(met.mean()), 0.0, 1.0, probability))
    found, events = (*doubts, *more), int(met.sum())
    sample = EventSample(vectors[met], weights[met], np.arange(events)) if events else None
    return Estimate(probability, low, high, budget, events, failed, found, tuple(stages), sample)


def _weighted(weights: Array, confidence: float) -> tuple[float, float, float, list[str]]:
    """Return the mean of the weights (n,), its interval, and reasons to doubt it."""
    n, total = len(weights), float(weights.sum())
    if not total:
        # a weight is at most 1 / _DEFENSIVE: the inputs' own share is plain Monte Carlo
        _, high = clopper_pearson(0, max(1, int(_DEFENSIVE * n)), confidence)
        return 0.0, 0.0, high, ["the mixture did not meet the event"]
    mean = total / n
    scatter = float(weights.std(ddof=1)) / np.sqrt(n) / mean
    effective = total**2 / float(np.sum(weights**2))
    half = float(scipy.stats.t.ppf(0.5 + confidence / 2.0, max(1.0, effective - 1.0))) * scatter
    doubts = []
    if effective < _LEAST_SIZE:
        doubts.append(
            f"the events' effective sample size is {effective:.0f}; expected {_LEAST_SIZE:g}: the "
            "weights are degenerate; raise the budget, or use --method subset"
        )
    shape = tail_shape(weights[weights > 0.0])
    if shape > _HEAVY:
        doubts.append(
            f"the weights have a heavy tail (shape {shape:.2f}, expected at most {_HEAVY:g}): rare "
            "runs may have been missed"
        )
    return mean, mean * float(np.exp(-half)), min(1.0, mean * float(np.exp(half))), doubts


def tail_shape(weights: Array) -> float:
    """Return the shape of the generalised Pareto distribution of the largest weights.

    Without 20 weights in the tail it is nan. It is negative for bounded weights.
    """
    count = int(_TAIL * len(weights))
    if count < 20:
        return float("nan")
    ordered = np.sort(weights)
    beyond = ordered[-count:] - ordered[-count - 1]
    if beyond[-1] <= 0.0:
        return -1.0
    shape, _, _ = scipy.stats.genpareto.fit(beyond / beyond.mean(), floc=0.0)
    return float(shape)


def _fitted(vectors: Array, logs: Array, random: np.random.Generator) -> Mixture:
    """Return the mixture fitted to weighted vectors (n, d) by expectation and maximisation."""
    n, dimension = vectors.shape
    weights = np.exp(logs - logsumexp(logs))
    effective = 1.0 / float(np.sum(weights**2))
    count = max(1, min(_COMPONENTS, int(effective / (2.0 * dimension + 2.0))))
    starts = random.choice(n, min(count, n), replace=False, p=_positive(weights))
    means = vectors[starts]
    shares = np.full(len(means), 1.0 / len(means))
    roots = np.repeat(np.eye(dimension)[None], len(means), axis=0)
    for _ in range(_ITERATIONS):
        mixture = Mixture(dimension, shares, means, roots)
        densities = np.column_stack(mixture.log_densities(vectors)) + np.log(shares)
        belongs = np.exp(densities - logsumexp(densities, axis=1, keepdims=True))
        mass = belongs * weights[:, None]
        total = mass.sum(axis=0)
        keep = total > 1e-3
        mass, total = mass[:, keep], total[keep]
        shares = total / total.sum()
        means = (mass.T @ vectors) / total[:, None]
        roots = np.array(
            [
                _root(vectors - mean, each / size, effective * size)
                for mean, each, size in zip(means, mass.T, total, strict=True)
            ]
        )
    return Mixture(dimension, shares, means, roots)


def _positive(weights: Array) -> Array:
    """Return the weights as probabilities of which none is 0."""
    positive = weights + 1e-12
    return np.asarray(positive / positive.sum())


def _root(offsets: Array, weights: Array, effective: float) -> Array:
    """Return the Cholesky factor (d, d) of a covariance, shrunk where there are few vectors."""
    dimension = offsets.shape[1]
    covariance = (offsets * weights[:, None]).T @ offsets
    diagonal = np.diag(np.diag(covariance))
    trust = effective / (effective + dimension)
    mixed = trust * covariance + (1.0 - trust) * diagonal
    root: Array = _WIDER * np.linalg.cholesky(mixed + _LEAST_VARIANCE * np.eye(dimension))
    return root
