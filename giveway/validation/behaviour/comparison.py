"""The comparison of simulated with recorded people: distances of distributions, and counts."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import wasserstein_distance

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.validation.behaviour.measures import (
    ACCELERATION,
    MEASURES,
    Behaviour,
    Measure,
    behaviour_of,
    near_vehicles,
    together,
)
from giveway.validation.behaviour.replaying import replayed, settled

RECORDED, SIMULATED = "recorded", "simulated"
HALVES = 200
"""Number of draws of two halves of the recorded people."""
SEED = 0
"""Seed of these draws."""
LEVELS = np.linspace(0.0, 1.0, 101)
"""Levels of the quantiles between which the halves' band is drawn."""
_BAND = (2.5, 97.5)  # Percentiles of the halves' quantiles
_FEWEST = 4  # Number of people in reach, below which nothing can be halved


@dataclass(frozen=True, eq=False)
class Distribution:
    """One measure of recorded and simulated people.

    Attributes:
        measure: Measure.
        recorded: Values (R,) of recorded people.
        simulated: Values (S,) of simulated people.
        distance: Wasserstein-1 distance of the two, in the measure's unit; nan if one is empty.
        floor: Mean of this distance between random halves of the recorded people.
        low, high: 95 % band (L,) of the halves' quantiles at ``LEVELS``.
    """

    measure: Measure
    recorded: Array
    simulated: Array
    distance: float
    floor: float
    low: Array
    high: Array

    @property
    def medians(self) -> tuple[float, float]:
        """The medians of recorded and of simulated people; nan without any value."""
        recorded, simulated = (
            float(np.median(values)) if len(values) else np.nan
            for values in (self.recorded, self.simulated)
        )
        return recorded, simulated

    @property
    def ratio(self) -> float:
        """The distance over its noise floor; 1 is as near as two halves of the recorded people."""
        return self.distance / self.floor if self.floor > 0.0 else np.nan


@dataclass(frozen=True)
class Counts:
    """The counts of recorded or of simulated people.

    Attributes:
        contacts: Number of people who touch a vehicle.
        close: Number of close passes: pairs of a person and a vehicle.
        pairs: Number of pairs of a person and a moving vehicle within 4 m.
        acceleration: Acceleration [m/s^2] near a moving vehicle that 95 % of samples are below.
    """

    contacts: int
    close: int
    pairs: int
    acceleration: float

    @property
    def close_share(self) -> float:
        """The share of pairs that are close passes; nan without any pair."""
        return self.close / self.pairs if self.pairs else np.nan


@dataclass(frozen=True, eq=False)
class Comparison:
    """The comparison of simulated with recorded people.

    Attributes:
        recordings: Number of recordings.
        people: Number of people in them.
        near: Number of these near a moving vehicle.
        distributions: Distributions, in the order of ``MEASURES``.
        counts: Counts, by ``RECORDED`` and ``SIMULATED``.
        table: Table with a row per person near a moving vehicle, recorded and simulated.
    """

    recordings: int
    people: int
    near: int
    distributions: tuple[Distribution, ...]
    counts: dict[str, Counts]
    table: pd.DataFrame

    @property
    def mean_ratio(self) -> float:
        """The mean of the ratios that are known."""
        ratios = [each.ratio for each in self.distributions if np.isfinite(each.ratio)]
        return float(np.mean(ratios)) if ratios else np.nan

    @property
    def summary(self) -> pd.DataFrame:
        """The distributions as a table, one row for each."""
        return pd.DataFrame([_row(each) for each in self.distributions])


def compare(
    recordings: Sequence[Recording],
    config: RunConfig,
    advance: Callable[[str], None] = lambda _name: None,
) -> Comparison:
    """Simulate the people of recordings among the recorded vehicles, and compare the two.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.
        config: Configuration that names the pedestrian model and its preset.
        advance: Function that is called with the name of each recording that is done.

    Raises:
        DatasetError: fewer than four people are near a moving vehicle.
    """
    parts: dict[str, list[Behaviour]] = {RECORDED: [], SIMULATED: []}
    names: list[tuple[str, str]] = []
    for read in recordings:
        recording = settled(read)
        near = near_vehicles(recording)
        names += [(recording.name, person) for person in recording.people.ids]
        parts[RECORDED].append(behaviour_of(recording, near))
        parts[SIMULATED].append(behaviour_of(replayed(recording, config), near))
        advance(recording.name)
    found = {who: together(each) for who, each in parts.items()}
    inside = np.flatnonzero(found[RECORDED].pairs)
    if len(inside) < _FEWEST:
        raise DatasetError(
            f"recordings: of {len(names)} people {len(inside)} are within 4 m of a vehicle "
            f"faster than 0.5 m/s; expected at least {_FEWEST}; giveway data describe lists "
            "people and vehicles"
        )
    return Comparison(
        recordings=len(recordings),
        people=len(names),
        near=len(inside),
        distributions=distributions(found[RECORDED], found[SIMULATED]),
        counts={who: _counts(each) for who, each in found.items()},
        table=_people(names, found),
    )


def distributions(recorded: Behaviour, simulated: Behaviour) -> tuple[Distribution, ...]:
    """Return the distribution of each measure, with the same halves for all of them."""
    inside = np.flatnonzero(recorded.pairs)
    generator = np.random.default_rng(SEED)
    halves = np.zeros((HALVES, len(recorded.pairs)), dtype=bool)
    for half in halves:
        half[generator.permutation(inside)[: len(inside) // 2]] = True
    return tuple(_distribution(each, recorded, simulated, halves) for each in MEASURES)


def _distribution(
    measure: Measure, recorded: Behaviour, simulated: Behaviour, halves: Array
) -> Distribution:
    samples, other = recorded.samples[measure.name], simulated.samples[measure.name].value
    floors, quantiles = [], []
    for half in halves:
        chosen = half[samples.person]
        one, two = samples.value[chosen], samples.value[~chosen]
        if len(one) and len(two):
            floors.append(wasserstein_distance(one, two))
            quantiles.append(np.quantile(one, LEVELS))
    known = len(samples.value) and len(other)
    band = np.percentile(quantiles, _BAND, axis=0) if quantiles else np.full((2, 101), np.nan)
    return Distribution(
        measure,
        samples.value,
        other,
        float(wasserstein_distance(samples.value, other)) if known else np.nan,
        float(np.mean(floors)) if floors else np.nan,
        *band,
    )


def _counts(found: Behaviour) -> Counts:
    hard = found.samples[ACCELERATION.name].value
    return Counts(
        contacts=int(found.contact.sum()),
        close=int(found.close.sum()),
        pairs=int(found.pairs.sum()),
        acceleration=float(np.quantile(hard, 0.95)) if len(hard) else np.nan,
    )


def _people(names: Sequence[tuple[str, str]], found: dict[str, Behaviour]) -> pd.DataFrame:
    """Return a row per person near a moving vehicle, for recorded and for simulated people."""
    tables = []
    for who, each in found.items():
        table = pd.DataFrame(names, columns=["recording", "person"])
        table["who"] = who
        for measure in MEASURES:
            table[measure.name] = each.of_each(measure)
        table["contact"] = each.contact
        table["vehicles"] = each.pairs
        table["close_passes"] = each.close
        tables.append(table[each.pairs > 0])
    return pd.concat(tables, ignore_index=True)


def _row(each: Distribution) -> dict[str, object]:
    row: dict[str, object] = {"measure": each.measure.name, "unit": each.measure.unit}
    counts = (len(each.recorded), len(each.simulated))
    for who, count, median in zip((RECORDED, SIMULATED), counts, each.medians, strict=True):
        row |= {f"{who}_count": count, f"{who}_median": median}
    return row | {"distance": each.distance, "floor": each.floor, "ratio": each.ratio}
