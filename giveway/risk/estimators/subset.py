"""Subset simulation: a small probability as a product of larger ones (Au & Beck 2001).

Each level is the criticality that a tenth of the runs exceeds. Chains walk beyond it by the
preconditioned Crank-Nicolson proposal v = sqrt(1 - s²) u + s w, which leaves the normal
distribution as it is (Cotter, Roberts, Stuart & White 2013; Papaioannou, Betz, Zwirglmaier &
Straub 2015). The states of a chain resemble one another. Therefore the interval comes from
independent repeats, and not from the number of runs. Few repeats may agree by luck: their spread is
then that of the shares of single chains. A level that is chosen from n runs makes the
product too large by the factor 1 + (1 - p0)/(n p0), by which it is divided (Cérou, Del Moral, Furon
& Guyader 2012, "Sequential Monte Carlo for rare event estimation", Statistics and Computing 22).
"""

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy  # scipy.stats is loaded where it is first used
from numpy.typing import NDArray

from giveway.risk.estimators.estimate import Array, Estimate, EventSample, Sampler, Stage
from giveway.risk.estimators.monte_carlo import clopper_pearson
from giveway.risk.estimators.scouts import Scouted, scouts

REPEATS = 10
LEAST_BUDGET = 3000  # Smallest budget whose levels have enough runs
SHARE = 0.1  # Share p0 of the runs beyond a level (Zuev, Beck, Au & Katafygiotis 2012)
_LEVELS = 9  # Largest number of levels; the probability is then below 1e-9
_TYPICAL_LEVELS = 5  # Number of levels for which a budget is shared out: 1e-5
_SCOUTS = 0.1  # Share of the budget that scouts take
_FLAT = 0.5  # Share of the runs on one level from which on the criticality is flat there
_ACCEPTED = 0.44  # Acceptance at which chains move best (Papaioannou et al. 2015)
_FIRST_STEP, _LEAST_STEP = 0.6, 0.05
_LEAST = 50  # Smallest number of runs of a level
_SPAN = 10.0  # Factor between the bounds from which on the repeats disagree


@dataclass
class _Repeat:
    """One repeat: its probability, and how it came about."""

    number: int
    probability: float = 1.0
    variance: float = 0.0  # of the logarithm of the probability, from the spread between chains
    flat: bool = False
    events: int = 0
    failed: int = 0
    first: tuple[int, int] = (0, 0)  # events and runs of the first level, which is Monte Carlo
    stages: list[Stage] = field(default_factory=list)
    met: Array | None = None  # states with the event (n, d)


def subset_simulation(
    dimension: int,
    budget: int,
    seed: int,
    confidence: float = 0.95,
    held: Sequence[int] = (),
) -> Sampler:
    """Estimate the probability by independent repeats of subset simulation.

    Args:
        dimension: Number of components of a vector.
        budget: Number of runs that are shared out, for a probability of 1e-5. A larger one needs
            fewer runs, and a smaller one more.
        seed: Seed of the vectors.
        confidence: Confidence of the interval.
        held: Components that half of the proposals leave as they are, and the others draw anew,
            such as the seed of noise.
    """
    ahead = int(_SCOUTS * budget)
    random = np.random.default_rng((seed, 0))
    scouting = scouts(dimension, ahead, random)
    found = yield scouting
    scouted = Scouted.of(scouting, found)
    per_repeat = (budget - ahead) / REPEATS
    size = max(_LEAST, int(per_repeat / (1.0 + (_TYPICAL_LEVELS - 1) * (1.0 - SHARE))))
    repeats = [_Repeat(number) for number in range(1, REPEATS + 1)]
    yield from _in_step(
        [_simulate(one, dimension, size, (seed, one.number), held) for one in repeats]
    )
    return _estimate(repeats, scouted, scouting, found, confidence)


def _in_step(walks: list[Generator[Array, Array, None]]) -> Generator[Array, Array, None]:
    """Run several generators of batches as one, whose batches join theirs."""
    asked = {number: next(walk) for number, walk in enumerate(walks)}
    while asked:
        answer = yield np.concatenate([*asked.values()])
        ends = np.cumsum([len(batch) for batch in asked.values()])[:-1]
        parts = dict(zip(asked, np.split(answer, ends), strict=True))
        asked = {}
        for number, part in parts.items():
            try:
                asked[number] = walks[number].send(part)
            except StopIteration:
                continue


def _simulate(
    repeat: _Repeat, dimension: int, size: int, seed: tuple[int, int], held: Sequence[int]
) -> Generator[Array, Array, None]:
    """Fill one repeat: plain runs first, then level by level."""
    random = np.random.default_rng(seed)
    vectors = random.standard_normal((size, dimension))
    found = _told(repeat, (yield vectors))
    repeat.first = int(np.count_nonzero(found >= 0.0)), size
    step, accepted, made, walks = _FIRST_STEP, 1.0, size, size
    for stage in range(1, _LEVELS + 1):
        seeds = max(1, round(SHARE * size))
        level = min(0.0, float(np.partition(found, -seeds)[-seeds]))
        beyond = found >= level
        share = float(beyond.mean())
        repeat.variance += variance_between(beyond, walks) / share**2
        repeat.probability *= share if level >= 0.0 else share / (1.0 + (1.0 - share) / seeds)
        moved = 0.0 if stage == 1 else step
        repeat.stages.append(
            Stage(repeat.number, stage, made, level, share, moved, accepted, repeat.probability)
        )
        if level >= 0.0:
            repeat.met = vectors[beyond]
            return
        if share > _FLAT or not np.isfinite(level):
            break
        chains = random.permutation(np.flatnonzero(beyond))
        walk = _Walk(vectors[chains], found[chains], level, step, random, held)
        made, walks = size - len(chains), len(chains)
        vectors, found = yield from walk.states(repeat, size)
        step, accepted = walk.step, walk.accepted
    repeat.probability, repeat.flat = 0.0, True


def variance_between(beyond: NDArray[np.bool_], walks: int) -> float:
    """Return the variance of the share of states beyond a level, from the shares of the chains.

    Args:
        beyond: Marks (n,) of the states; those of one chain are ``walks`` apart.
        walks: Number of chains.
    """
    chain = np.arange(len(beyond)) % walks
    shares = np.bincount(chain, weights=beyond) / np.bincount(chain)
    return float(shares.var(ddof=1)) / walks if walks > 1 else 0.0


def _told(repeat: _Repeat, criticality: Array) -> Array:
    """Count events and runs without a result, which are beyond no level."""
    failed = np.isnan(criticality)
    repeat.failed += int(np.count_nonzero(failed))
    repeat.events += int(np.count_nonzero(criticality >= 0.0))
    return np.where(failed, -np.inf, criticality)


class _Walk:
    """Chains beyond one level."""

    def __init__(
        self,
        vectors: Array,
        criticality: Array,
        level: float,
        step: float,
        random: np.random.Generator,
        held: Sequence[int],
    ) -> None:
        self._vectors, self._criticality, self._level = vectors, criticality, level
        self._random, self._held = random, held
        self.step = step
        self.accepted = 0.0

    def states(self, repeat: _Repeat, size: int) -> Generator[Array, Array, tuple[Array, Array]]:
        """Return ``size`` states of the chains, the first of each chain included."""
        states, values = [self._vectors], [self._criticality]
        tried = taken = 0
        left = size - len(self._vectors)
        while left > 0:
            count = min(left, len(self._vectors))
            now, worth = self._vectors[:count], self._criticality[:count]
            holds = self._random.random(count) < (0.5 if self._held else 1.0)
            proposed = self._proposals(now, holds)
            found = _told(repeat, (yield proposed))
            moves = found >= self._level
            self._vectors = np.where(moves[:, None], proposed, now)
            self._criticality = np.where(moves, found, worth)
            states.append(self._vectors)
            values.append(self._criticality)
            tried, taken, left = tried + count, taken + int(moves.sum()), left - count
            if holds.any():
                self._adapt(float(moves[holds].mean()), len(states) - 1)
        self.accepted = taken / max(1, tried)
        return np.concatenate(states), np.concatenate(values)

    def _proposals(self, now: Array, holds: NDArray[np.bool_]) -> Array:
        """Return a proposal for each state (n, d); where ``holds`` (n,), some components stay."""
        fresh = self._random.standard_normal(now.shape)
        proposed: Array = np.sqrt(1.0 - self.step**2) * now + self.step * fresh
        for component in self._held:
            proposed[holds, component] = now[holds, component]
            proposed[~holds, component] = fresh[~holds, component]
        return proposed

    def _adapt(self, accepted: float, moves: int) -> None:
        """Change the step towards the best acceptance, less and less.

        A proposal with another seed is another run, whatever the step. It does not count.
        """
        factor = np.exp((accepted - _ACCEPTED) / np.sqrt(moves))
        self.step = float(np.clip(self.step * factor, _LEAST_STEP, 1.0))


def _estimate(
    repeats: Sequence[_Repeat],
    scouted: Scouted,
    scouting: Array,
    found: Array,
    confidence: float,
) -> Estimate:
    """Return the estimate from all repeats and the scouts."""
    each = np.array([repeat.probability for repeat in repeats])
    runs = len(scouting) + sum(stage.runs for repeat in repeats for stage in repeat.stages)
    first = np.array([repeat.first for repeat in repeats]).sum(axis=0)
    failed = sum(repeat.failed for repeat in repeats) + int(np.isnan(found).sum())
    doubts = []
    flat = sum(repeat.flat for repeat in repeats)
    if flat:
        doubts.append(
            f"{flat} of {len(repeats)} repeats did not reach the event: the criticality is flat, "
            f"or the event rarer than {SHARE**_LEVELS:g}"
        )
    if failed:
        doubts.append(f"{failed} runs have no result, and count as runs without the event")
    plain = clopper_pearson(int(first[0]), int(first[1]), confidence)[1]
    if flat:
        probability, low, high = float(each.mean()), 0.0, plain
    else:
        least = float(np.mean([repeat.variance for repeat in repeats]))
        probability, low, high = interval_of_repeats(each, confidence, least)
        if high > _SPAN * low:
            doubts.append(
                f"the repeats disagree: by them alone the upper bound is {high / low:.0f} times "
                "the lower one; raise the budget"
            )
            high = min(high, plain)
    if scouted.low > high:
        doubts.append(
            f"scouts far from the usual inputs find {scouted.probability:.2g}: the chains missed "
            "the region of most events; the interval is widened to the scouts'"
        )
        high = scouted.high
    return Estimate(
        probability,
        low,
        min(1.0, high),
        runs,
        sum(repeat.events for repeat in repeats) + scouted.events,
        failed,
        tuple(doubts),
        tuple(stage for repeat in repeats for stage in repeat.stages),
        _sample(repeats),
    )


def _sample(repeats: Sequence[_Repeat]) -> EventSample | None:
    """Return the states with the event: a repeat's have its probability as weight in all."""
    reached = [(repeat, repeat.met) for repeat in repeats if repeat.met is not None]
    if not reached:
        return None
    counts = [len(met) for _, met in reached]
    weights = [repeat.probability / len(met) for repeat, met in reached]
    numbers = [repeat.number for repeat, _ in reached]
    vectors = np.concatenate([met for _, met in reached])
    return EventSample(vectors, np.repeat(weights, counts), np.repeat(numbers, counts))


def interval_of_repeats(
    each: Array, confidence: float, least: float = 0.0
) -> tuple[float, float, float]:
    """Return the mean of independent estimates (n,), and its interval.

    Estimates by subset simulation are about lognormal. The interval is that of Cox for the mean of
    a lognormal distribution, with Student's t (Olsson 2005, "Confidence intervals for the mean of a
    log-normal distribution", Journal of Statistics Education 13).

    Args:
        each: Estimates above 0.
        confidence: Confidence of the interval.
        least: Smallest variance of the logarithm of an estimate.
    """
    logs, n = np.log(each), len(each)
    square = max(least, float(logs.var(ddof=1)))
    centre = float(logs.mean()) + square / 2.0
    quantile = float(scipy.stats.t.ppf(0.5 + confidence / 2.0, n - 1))
    half = quantile * np.sqrt(square / n + square**2 / (2.0 * (n - 1)))
    return float(each.mean()), float(np.exp(centre - half)), float(np.exp(centre + half))
