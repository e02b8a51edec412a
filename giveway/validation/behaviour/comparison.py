"""The comparison of simulated with recorded people: distances of distributions, and counts.

People are simulated several times with other desired speeds and sways, and all of them are compared
with the recorded ones, so that little depends on a draw.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import wasserstein_distance

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.validation.behaviour.measures import (
    ACCELERATION,
    ALL,
    ENCROACHMENT,
    MEASURES,
    Behaviour,
    Measure,
    Samples,
    behaviour_of,
    near_vehicles,
    together,
)
from giveway.validation.behaviour.replaying import replayed, settled
from pedestrian_model import VciParameters

RECORDED, SIMULATED = "recorded", "simulated"
HALVES = 200
"""Number of draws of two halves of the recorded people."""
SEED = 0
"""Seed of these draws."""
DRAWS = 5
"""Number of times that people are simulated."""
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
        contacts: Number of people who touch a vehicle; if simulated, the mean of the draws.
        close: Number of close passes: pairs of a person and a vehicle; if simulated, the mean.
        pairs: Number of pairs of a person and a moving vehicle within 4 m.
        acceleration: Acceleration [m/s^2] near a moving vehicle that 95 % of samples are below.
        first: Share of people who cross a vehicle's path before it, of those who cross it.
    """

    contacts: float
    close: float
    pairs: int
    acceleration: float
    first: float

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
        distributions: Distributions, in the order of ``ALL``.
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
        """The mean of the ratios of ``MEASURES`` that are known."""
        ratios = [each.ratio for each in self.distributions[: len(MEASURES)]]
        ratios = [ratio for ratio in ratios if np.isfinite(ratio)]
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
    yardstick = Yardstick(recordings)
    simulated = yardstick.simulated(config, DRAWS, advance)
    found = {RECORDED: yardstick.recorded, SIMULATED: together(simulated)}
    return Comparison(
        recordings=len(recordings),
        people=len(yardstick.names),
        near=yardstick.near,
        distributions=yardstick.distributions(found[SIMULATED]),
        counts={RECORDED: counts_of([yardstick.recorded]), SIMULATED: counts_of(simulated)},
        table=_people(yardstick.names, {RECORDED: yardstick.recorded, SIMULATED: simulated[0]}),
    )


class Yardstick:
    """Recorded people, with which simulated ones are compared, and how far two halves differ.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.

    Raises:
        DatasetError: fewer than four people are near a moving vehicle.
    """

    def __init__(self, recordings: Sequence[Recording]) -> None:
        self._recordings = [settled(read) for read in recordings]
        self._near = [near_vehicles(each) for each in self._recordings]
        self.names = [(each.name, who) for each in self._recordings for who in each.people.ids]
        pairs = zip(self._recordings, self._near, strict=True)
        self.recorded = together([behaviour_of(*pair) for pair in pairs])
        inside = np.flatnonzero(self.recorded.pairs)
        self.near = len(inside)
        if self.near < _FEWEST:
            raise DatasetError(
                f"recordings: of {len(self.names)} people {self.near} are within 4 m of a vehicle "
                f"faster than 0.5 m/s; expected at least {_FEWEST}; giveway data describe lists "
                "people and vehicles"
            )
        self._floors = floors_of(self.recorded)

    def simulated(
        self,
        config: RunConfig,
        draws: int,
        advance: Callable[[str], None] = lambda _name: None,
        parameters: VciParameters | None = None,
    ) -> list[Behaviour]:
        """Return the behaviour of simulated people, of each draw.

        Args:
            config: Configuration that names the pedestrian model and its preset.
            draws: Number of draws of desired speeds and sways.
            advance: Function that is called with the name of each recording that is done.
            parameters: Parameters of VCI in place of the preset's, or None.
        """
        found: list[list[Behaviour]] = [[] for _ in range(draws)]
        for recording, near in zip(self._recordings, self._near, strict=True):
            for draw, each in enumerate(found):
                each.append(behaviour_of(replayed(recording, config, draw, parameters), near))
            advance(recording.name)
        return [together(each) for each in found]

    @property
    def floors(self) -> dict[str, float]:
        """The noise floor of each measure, by its name; it changes with any recorded person."""
        return {name: floor.distance for name, floor in self._floors.items()}

    def ratios(self, simulated: Behaviour) -> dict[str, float]:
        """Return the ratio of each measure that has a floor, by its name; nan without samples."""
        found = self.distributions(simulated)
        return {each.measure.name: each.ratio for each in found if each.floor > 0.0}

    def distributions(self, simulated: Behaviour) -> tuple[Distribution, ...]:
        """Return the distribution of each measure."""
        return distributions(self.recorded, simulated, self._floors)


class Floor(NamedTuple):
    """The difference between two halves of the recorded people, in one measure.

    Attributes:
        distance: Mean Wasserstein-1 distance between the halves, in the measure's unit.
        low, high: 95 % band (L,) of the halves' quantiles at ``LEVELS``.
    """

    distance: float
    low: Array
    high: Array


def floors_of(recorded: Behaviour) -> dict[str, Floor]:
    """Return the floor of each measure, with the same halves for all of them."""
    inside = np.flatnonzero(recorded.pairs)
    generator = np.random.default_rng(SEED)
    halves = np.zeros((HALVES, len(recorded.pairs)), dtype=bool)
    for half in halves:
        half[generator.permutation(inside)[: len(inside) // 2]] = True
    return {each.name: _floor(recorded.samples[each.name], halves) for each in ALL}


def _floor(samples: Samples, halves: Array) -> Floor:
    distances, quantiles = [], []
    for half in halves:
        chosen = half[samples.person]
        one, two = samples.value[chosen], samples.value[~chosen]
        if len(one) and len(two):
            distances.append(wasserstein_distance(one, two))
            quantiles.append(np.quantile(one, LEVELS))
    band = np.percentile(quantiles, _BAND, axis=0) if quantiles else np.full((2, 101), np.nan)
    return Floor(float(np.mean(distances)) if distances else np.nan, *band)


def distributions(
    recorded: Behaviour, simulated: Behaviour, floors: Mapping[str, Floor]
) -> tuple[Distribution, ...]:
    """Return the distribution of each measure.

    Args:
        recorded: Recorded people.
        simulated: Simulated people, of all draws.
        floors: Floors by measure, see :func:`floors_of`.
    """
    return tuple(
        _distribution(each, recorded.samples[each.name], simulated.samples[each.name], floors)
        for each in ALL
    )


def _distribution(
    measure: Measure, recorded: Samples, simulated: Samples, floors: Mapping[str, Floor]
) -> Distribution:
    both = recorded.value, simulated.value
    known = all(len(values) for values in both)
    distance = float(wasserstein_distance(*both)) if known else np.nan
    floor, low, high = floors[measure.name]
    return Distribution(measure, *both, distance, floor, low, high)


def counts_of(draws: list[Behaviour]) -> Counts:
    """Return the counts of people: means of the draws, or those of the recorded people alone."""
    both = together(draws)
    signed = both.samples[ENCROACHMENT.name].value
    return Counts(
        contacts=float(np.mean([each.contact.sum() for each in draws])),
        close=float(np.mean([each.close.sum() for each in draws])),
        pairs=int(draws[0].pairs.sum()),
        acceleration=hardest(both, ACCELERATION),
        first=float(np.mean(signed > 0.0)) if len(signed) else np.nan,
    )


def hardest(found: Behaviour, measure: Measure) -> float:
    """Return the value of a measure that 95 % of its samples are below; nan without any."""
    values = found.samples[measure.name].value
    return float(np.quantile(values, 0.95)) if len(values) else np.nan


def _people(names: Sequence[tuple[str, str]], found: dict[str, Behaviour]) -> pd.DataFrame:
    """Return a row per person near a moving vehicle, for recorded and for simulated people."""
    tables = []
    for who, each in found.items():
        table = pd.DataFrame(names, columns=["recording", "person"])
        table["who"] = who
        for measure in ALL:
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
