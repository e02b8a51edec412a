"""The inputs given the event, and the share of each in it, from the vectors that have the event.

A component's first-order Sobol index of the event is p/(1 - p) times the mean square of f/g - 1,
where g is the density of the component, and f that given the event (Li, Papaioannou & Straub 2019,
"Global reliability sensitivity estimation based on failure samples", Structural Safety 81). The
square is taken over pairs of independent vectors alone, so that the index has no bias.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # scipy.stats is loaded where it is first used
from scipy.special import ndtr, ndtri

from giveway.risk.estimators.estimate import Array, EventSample

LEAST_EVENTS = 50  # Smallest number of different vectors whose distribution means something
_EDGES = np.linspace(-4.0, 4.0, 17)  # Limits of the classes, in standard deviations


@dataclass(frozen=True)
class EventIndex:
    """The share of the event's variance that one component explains alone, with its interval."""

    index: float
    low: float
    high: float


def event_index(
    sample: EventSample,
    component: int,
    probability: float,
    confidence: float = 0.95,
    classes: int | None = None,
) -> EventIndex:
    """Return the index of one component; nan where the event is sure or has one source.

    The interval is that of the jackknife over the independent sources of the vectors.

    Args:
        sample: Vectors with the event.
        component: Number of the component.
        probability: Probability of the event.
        confidence: Confidence of the interval.
        classes: Number of equally likely values of the component, or None if it is continuous.
    """
    edges = _EDGES if classes is None else ndtri(np.arange(1, classes) / classes)
    own = np.diff([0.0, *ndtr(edges), 1.0])
    sources, of_source = np.unique(sample.sources, return_inverse=True)
    count = len(sources)
    if count < 2 or not 0.0 < probability < 1.0:
        return EventIndex(np.nan, np.nan, np.nan)
    mass = np.zeros((count, len(own)))
    place = np.searchsorted(edges, sample.vectors[:, component])
    np.add.at(mass, (of_source, place), sample.weights)
    total, mass = mass.sum(axis=1), mass / np.sqrt(own)
    square = np.einsum("ij,ij->i", mass, mass)
    every, whole = mass.sum(axis=0), float(total.sum())

    def departure(pairs: Array, all_pairs: Array) -> Array:
        return np.asarray(pairs / all_pairs - 1.0)

    numerator = every @ every - square.sum()
    denominator = whole**2 - float(total @ total)
    scale = probability / (1.0 - probability)
    index = scale * float(departure(numerator, np.asarray(denominator)))
    # without one source, all its pairs with the others are missing
    fewer = numerator - 2.0 * (mass @ every - square)
    without = scale * departure(fewer, denominator - 2.0 * total * (whole - total))
    error = math.sqrt((count - 1) * float(np.var(without)))
    half = float(scipy.stats.t.ppf(0.5 + confidence / 2.0, count - 1)) * error
    return EventIndex(index, max(0.0, index - half), min(1.0, index + half))


def weighted_quantiles(values: Array, weights: Array, shares: Sequence[float]) -> Array:
    """Return quantiles of weighted values (n,)."""
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order]) / weights.sum()
    places = np.searchsorted(reached, np.asarray(shares) - 1e-12)
    return np.asarray(values[order][np.minimum(places, len(values) - 1)])
