"""The interval of a mean by the bias-corrected and accelerated (BCa) bootstrap of scipy.

Efron 1987, "Better bootstrap confidence intervals", J. Am. Stat. Assoc. 82, 171-185.
"""

import contextlib
import functools
import hashlib
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
import scipy  # scipy.stats is loaded where it is first used
from numpy.typing import NDArray

from giveway.geometry.kernel import Array, unlocked
from giveway.processes.processors import processors
from giveway.studies.statistics.rounding import in_units

BCA = "BCa"
PERCENTILE = "percentile"
CONSTANT = "constant"

MOST_FOR_BCA = 10_000  # Largest sample for BCa: its jackknife takes n^2 additions
_NUMBERS_AT_ONCE = 300_000  # Number of random numbers that are drawn at a time

Item = TypeVar("Item")
Row = TypeVar("Row")


@dataclass(frozen=True)
class Interval:
    """The confidence interval of a mean.

    Attributes:
        low: Lower end.
        high: Upper end.
        method: "BCa"; "percentile" if BCa is not defined or not needed; "constant" if all values
            are equal.
    """

    low: float
    high: float
    method: str

    @property
    def width(self) -> float:
        """The width between both ends."""
        return self.high - self.low

    def excludes_zero(self) -> bool:
        """True if both ends are on one side of zero."""
        return self.low > 0.0 or self.high < 0.0


def seed_of(names: Iterable[str]) -> int:
    """Return 64 bits that depend only on the names, not on the order in which rows are computed."""
    digest = hashlib.blake2b("\x1f".join(names).encode(), digest_size=8).digest()
    return int.from_bytes(digest, "little")


def side_by_side(function: Callable[[Item], Row], items: Sequence[Item]) -> list[Row]:
    """Return the results of a function for each item, in order, computed on all processors.

    Drawing and adding up, which are most of the work, do not hold Python's lock.
    """
    with _quiet(), ThreadPoolExecutor(processors()) as pool:
        return list(pool.map(function, items))


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress scipy's warning about data that vary too little: :class:`Interval` says so."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", scipy.stats.DegenerateDataWarning)
        yield


def mean_interval(sample: Array, *, confidence: float, resamples: int, seed: int) -> Interval:
    """Return the BCa interval of the mean.

    Args:
        sample: Independent finite numbers (n,), at least one. They are rounded to six decimals, so
            that rounding errors do not decide whether a resample's mean equals the sample's.
        confidence: Probability that the interval covers the mean, between 0 and 1.
        resamples: Number of resamples of the bootstrap.
        seed: Seed of its draws, 64 bits.

    Returns:
        The interval, which is the value itself if all are equal. It is the percentile interval if
        BCa is not defined (all resamples on one side of the mean, or an acceleration beyond the
        formula's pole), and for more than ``MOST_FOR_BCA`` numbers, for which the corrections are
        negligible.
    """
    whole, per_one = in_units(sample)
    if np.all(whole == whole[0]):
        value = float(whole[0]) / per_one
        return Interval(value, value, CONSTANT)
    interval = functools.partial(
        scipy.stats.bootstrap,
        (whole,),
        np.mean,
        n_resamples=0,
        vectorized=True,
        confidence_level=confidence,
        batch=max(1, _NUMBERS_AT_ONCE // whole.size),
        bootstrap_result=_Resampled(_resampled_means(whole, resamples, seed)),
    )
    method = BCA if whole.size <= MOST_FOR_BCA else PERCENTILE
    with _quiet(), np.errstate(all="ignore"):
        low, high = interval(method=method).confidence_interval
    if not low < high:  # nan: BCa is not defined; low > high: beyond the pole of its formula
        method = PERCENTILE
        low, high = interval(method=method).confidence_interval
    return Interval(float(low) / per_one, float(high) / per_one, method)


class _Resampled(NamedTuple):
    """A stand-in for scipy's bootstrap result, with resamples that have already been drawn."""

    bootstrap_distribution: Array


def _resampled_means(whole: Array, resamples: int, seed: int) -> Array:
    """Return the means (resamples,) of resamples of whole numbers, drawn with that seed.

    They equal the means of scipy's bootstrap to the last bit: sums of whole numbers are exact in
    any order, and the numbers drawn are the same.
    """
    rng, means = np.random.default_rng(seed), np.empty(resamples)
    rows = max(1, _NUMBERS_AT_ONCE // whole.size)
    for first in range(0, resamples, rows):
        part = means[first : first + rows]
        which = rng.integers(0, whole.size, (part.size, whole.size), dtype=np.int32)
        _add_up(whole, which, part)
    return means / whole.size


@unlocked
def _add_up(numbers: Array, which: NDArray[np.int32], sums: Array) -> None:
    """Fill ``sums`` (k,) with the sums of the ``numbers`` (n,) in each row of ``which``."""
    for row in range(which.shape[0]):
        total = 0.0
        for column in range(which.shape[1]):
            total += numbers[which[row, column]]
        sums[row] = total
