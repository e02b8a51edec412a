"""Estimators of a small probability, which know nothing of simulations.

The event holds where the criticality c(u) of a vector u of independent standard normal numbers is
at least 0. An estimator is a generator: it yields batches of vectors (n, d), is sent their
criticality (n,), and returns an :class:`Estimate`. A criticality of nan is that of a run without a
result.
"""

from giveway.risk.estimators import importance, subset
from giveway.risk.estimators.estimate import Estimate, EventSample, Sampler, Stage, run_sampler
from giveway.risk.estimators.given_event import (
    LEAST_EVENTS,
    EventIndex,
    event_index,
    weighted_quantiles,
)
from giveway.risk.estimators.importance import importance_sampling
from giveway.risk.estimators.monte_carlo import clopper_pearson, monte_carlo
from giveway.risk.estimators.sobol import LEAST_VECTORS, SobolIndex, sobol_indices
from giveway.risk.estimators.subset import subset_simulation

LEAST_BUDGETS = {"subset": subset.LEAST_BUDGET, "importance": importance.LEAST_BUDGET}
"""The smallest budgets of the estimators that have one, by method."""

__all__ = [
    "LEAST_BUDGETS",
    "LEAST_EVENTS",
    "LEAST_VECTORS",
    "Estimate",
    "EventIndex",
    "EventSample",
    "Sampler",
    "SobolIndex",
    "Stage",
    "clopper_pearson",
    "event_index",
    "importance_sampling",
    "monte_carlo",
    "run_sampler",
    "sobol_indices",
    "subset_simulation",
    "weighted_quantiles",
]
