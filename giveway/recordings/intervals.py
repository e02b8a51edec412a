"""Intervals of means over people who share clips: the bootstrap over clips.

Pedestrians of one clip, and windows of one pedestrian, are not independent, but clips are.
Therefore whole clips are drawn (Davison & Hinkley 1997, "Bootstrap Methods and their Application",
section 3.8).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from giveway.geometry.kernel import Array

CONFIDENCE = 0.95
TAILS = ((1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0)
RESAMPLES = 5000


@dataclass(frozen=True, eq=False)
class ClipBootstrap:
    """The draws of clips, which are the same for every number, so that differences are paired.

    Attributes:
        weights: Number (B, C) of draws of each clip.
    """

    weights: Array

    @classmethod
    def of(cls, clips: int, seed: int = 0, resamples: int = RESAMPLES) -> ClipBootstrap:
        """Draw as many clips as there are, with replacement."""
        rng = np.random.default_rng(seed)
        return cls(rng.multinomial(clips, np.full(clips, 1.0 / clips), resamples).astype(float))

    def interval(self, total: Array, count: Array) -> tuple[float, float]:
        """Return the percentile interval of ``sum(total) / sum(count)``, both (C,).

        It is (nan, nan) if fewer than two clips have a count.
        """
        if np.count_nonzero(count) < 2:
            return np.nan, np.nan
        with np.errstate(divide="ignore", invalid="ignore"):
            means = np.einsum("rc,c", self.weights, total) / np.einsum("rc,c", self.weights, count)
        low, high = np.nanquantile(means, TAILS)
        return float(low), float(high)
