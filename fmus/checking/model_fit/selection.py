"""The choice of each side's response among nested structures, by Schwarz's criterion (BIC)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fmus.checking.model_fit.estimation import Estimate, refine
from fmus.checking.model_fit.measurements import Measurements
from fmus.checking.model_fit.side_response import SideResponse

CLEARLY = 10.0  # difference of the criterion that counts as evidence (Raftery 1995: very strong)
ROUNDS = 4  # largest number of structures that are added to a side
PROMISING = 6  # number of structures that are fitted in a round, after a rough comparison
NOTHING = 0.02  # difference of an exponent from 1, or of two lags [s], that is none
LAGS = (0.02, 0.1, 0.3, 0.6, 1.0)  # [s] from which a search begins
DELAYS = (0.0, 0.05, 0.2, 0.5)  # [s] likewise
SHARES = (0.12, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 0.95)  # limits over the largest command
RATES = (0.3, 0.6, 1.0, 2.0, 4.0)  # [1/s] rates over the largest command
SPEEDS = (4.0, 8.0, 14.0)  # [m/s] from which the power is constant
FREQUENCIES = (0.7, 1.0, 1.4, 2.0, 2.8, 4.0)  # [Hz] of a drive line
DEFAULT = SideResponse()

Candidates = Iterator[tuple[list[SideResponse], tuple[str, ...]]]


def identify_sides(measured: Measurements, *, coarse: bool = False) -> Estimate:
    """Return the simplest estimate that explains the measurements.

    Args:
        measured: Measurements.
        coarse: True to look only for lag, dead time, and limits of force and rate.
    """
    best = Estimate.of(measured)
    for side in (0, 1, 0):
        if not best.covers():
            starts = [SideResponse(lag=lag, delay=late) for lag in LAGS for late in DELAYS]
            names = best.names[side]
            start = best.responses[side] if names else _best(best, side, starts)
            best = refine(best, side, start, ("lag", "delay"))
    for _ in range(ROUNDS):
        before = best
        for side in (0, 1):
            if not best.covers():
                structures = _essential if coarse else _candidates
                best = _grown(best, side, structures(best, side))
        if best is before:
            break
    return _pruned(best)


def _best(estimate: Estimate, side: int, starts: list[SideResponse]) -> SideResponse:
    return min(starts, key=lambda start: estimate.try_out(side, start))


def _criterion(estimate: Estimate) -> float:
    # Residuals are hardly independent: each parameter counts twice.
    penalty = 2.0 * np.log(estimate.measured.acceleration.size)
    return estimate.linear.cost + float(penalty) * estimate.size


def _grown(estimate: Estimate, side: int, candidates: Candidates) -> Estimate:
    """Return the estimate with one more structure on a side, or the same if none is better."""
    tried = [
        refine(estimate, side, _best(estimate, side, starts), names) for starts, names in candidates
    ]
    found = min(tried, key=_criterion, default=estimate)
    if _criterion(found) > _criterion(estimate) - CLEARLY:
        return estimate
    other = 1 - side
    return min(
        found, refine(found, other, found.responses[other], found.names[other]), key=_criterion
    )


def _essential(estimate: Estimate, side: int) -> Candidates:
    """Generate the limits of force and rate that a side may have in addition."""
    now, names = estimate.responses[side], estimate.names[side]
    top = float(estimate.measured.commands[side].max())
    if "limit" not in names:
        yield [replace(now, limit=part * top) for part in SHARES], (*names, "limit")
    if "rate" not in names:
        prompt = replace(now, lag=0.0, second=0.0, delay=0.0, release=None)
        rest = tuple(name for name in names if name not in ("lag", "second", "delay", "release"))
        yield [replace(prompt, rate=part * top) for part in RATES], (*rest, "rate")


def _candidates(estimate: Estimate, side: int) -> Candidates:
    """Generate the structures that a side may have in addition, each with values to begin with."""
    yield from _essential(estimate, side)
    now, names = estimate.responses[side], estimate.names[side]
    top = float(estimate.measured.commands[side].max())
    rest = tuple(name for name in names if name not in ("lag", "delay"))
    if "second" not in names and now.release is None:
        turns = 1.0 / (2.0 * np.pi * np.array(FREQUENCIES))
        shaken = [
            replace(now, lag=2.0 * damping * turn, second=turn**2, delay=0.0)
            for turn in turns
            for damping in (0.1, 0.3)
        ]
        yield shaken, (*rest, "lag", "second")
        total = now.lag + now.delay
        twice = [
            replace(now, lag=total - late, second=(total - late) ** 2 * part, delay=late)
            for part in (0.05, 0.12, 0.2, 0.25)
            for late in (0.0, 0.5 * now.delay, now.delay)
        ]
        yield twice, (*rest, "lag", "second", "delay")
    if "release" not in names and "second" not in names:
        yield [replace(now, release=now.lag * part) for part in (0.3, 0.7, 1.5, 3.0)], (
            *names, "release")  # fmt: skip
    if "limit" not in names:
        late = [replace(now, limit=part * top, late_limits=True) for part in SHARES]
        yield late, (*names, "limit")
    if "power" not in names and side == 0:
        limits = (now.limit / top,) if "limit" in names else SHARES[1::2]
        unlimited = tuple(name for name in names if name != "limit")
        for behind in (False, True):
            powers = [
                replace(now, limit=part * top, power=part * top * v, late_limits=behind)
                for part in limits
                for v in SPEEDS
            ]
            yield powers, (*unlimited, "limit", "power")
    if "rate" not in names:
        yield [replace(now, rate=part * top) for part in RATES], (*names, "rate")
    if "exponent" not in names:
        curved = [replace(now, exponent=part, full=top) for part in (0.7, 1.4, 2.0)]
        yield curved, (*names, "exponent")


def _pruned(estimate: Estimate) -> Estimate:
    """Return the estimate without the parameters that explain nothing, or next to nothing."""
    for side in (0, 1):
        for name in estimate.names[side]:
            names = tuple(other for other in estimate.names[side] if other != name)
            if name == "lag" and "second" in names:
                continue
            now = estimate.responses[side]
            less = refine(estimate, side, replace(now, **{name: getattr(DEFAULT, name)}), names)
            tiny = {"exponent": now.exponent - 1.0, "release": (now.release or 0.0) - now.lag}
            if abs(tiny.get(name, 1.0)) < NOTHING:
                estimate = less
            estimate = min(less, estimate, key=_criterion)
    return estimate
