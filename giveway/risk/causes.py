"""The causes of the event: the inputs given it, and the likeliest runs in which it happens."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.config.tables.crowd import DRAWS_PER_PERSON
from giveway.risk.estimators import (
    LEAST_EVENTS,
    EventIndex,
    EventSample,
    event_index,
    weighted_quantiles,
)
from giveway.risk.inputs import CHOICE, CROWD, SEED, RandomInput
from giveway.risk.plan import RiskRun
from giveway.risk.risk_folder import RiskFolder
from giveway.studies.record import RunRecord

LISTED = 10  # Number of likeliest runs
QUANTILES = (0.05, 0.5, 0.95)
_OF_PERSON = ("start 1", "start 2", "speed")  # Names of a person's components
assert len(_OF_PERSON) == DRAWS_PER_PERSON


@dataclass(frozen=True)
class Component:
    """One component of the vector that is not the seed.

    Attributes:
        number: Number of the component.
        name: Name of the input, or of a person's component.
        declared: The declared input, or None for a person's component.
    """

    number: int
    name: str
    declared: RandomInput | None = None

    @property
    def classes(self) -> int | None:
        """The number of values of a choice, or None."""
        one = self.declared
        return len(one.numbers) if one is not None and one.distribution == CHOICE else None

    @property
    def is_number(self) -> bool:
        """True if its values are numbers."""
        return self.classes is None

    def values(self, components: NDArray[np.float64]) -> list[Any]:
        """Return the values for numbers (n,) of the vector; a person's are in deviations."""
        numbers: list[float] = components.tolist()
        return numbers if self.declared is None else list(map(self.declared.value, numbers))


@dataclass(frozen=True)
class Condition:
    """The distribution of one component given the event, beside its own.

    Attributes:
        component: Component.
        index: Share of the event's variance that it explains alone.
        own: Its 5, 50 and 95 % quantiles; nan for a choice.
        given: The same given the event.
        shares: Share of each value of a choice given the event.
    """

    component: Component
    index: EventIndex
    own: tuple[float, ...]
    given: tuple[float, ...]
    shares: dict[str, float]


def components_of(folder: RiskFolder) -> list[Component]:
    """Return the components of the vector that are not the seed."""
    inputs = folder.plan.inputs
    first = SEED + 1
    scalars = [Component(first + k, one.name, one) for k, one in enumerate(inputs.scalars)]
    first += len(scalars)
    return scalars + [
        Component(first + DRAWS_PER_PERSON * person + k, f"{CROWD} {person + 1} {name}")
        for person in range(inputs.people)
        for k, name in enumerate(_OF_PERSON)
    ]


def events_known(folder: RiskFolder) -> int:
    """Return the number of different vectors from which the inputs given the event are known."""
    sample = folder.estimate.sample
    return 0 if sample is None else len(np.unique(sample.vectors, axis=0))


def conditions(folder: RiskFolder) -> list[Condition]:
    """Return each component given the event, the largest index first; empty with few events."""
    sample = folder.estimate.sample
    if sample is None or events_known(folder) < LEAST_EVENTS:
        return []
    found = [_condition(folder, sample, one) for one in components_of(folder)]
    return sorted(found, key=lambda one: -np.nan_to_num(one.index.index, nan=-1.0))


def _condition(folder: RiskFolder, sample: EventSample, one: Component) -> Condition:
    probability, confidence = folder.estimate.probability, folder.plan.definition.confidence
    index = event_index(sample, one.number, probability, confidence, one.classes)
    values = one.values(sample.vectors[:, one.number])
    if not one.is_number:
        unknown = (np.nan,) * len(QUANTILES)
        return Condition(one, index, unknown, unknown, _shares(values, sample.weights, one))
    own = one.values(_NORMAL_QUANTILES)
    given = weighted_quantiles(np.array(values, dtype=float), sample.weights, QUANTILES)
    return Condition(one, index, tuple(own), tuple(given.tolist()), {})


_NORMAL_QUANTILES = np.array([-1.6448536269514722, 0.0, 1.6448536269514722])


def _shares(values: list[Any], weights: NDArray[np.float64], one: Component) -> dict[str, float]:
    total = float(weights.sum())
    met = np.array([str(value) for value in values])
    declared = () if one.declared is None else one.declared.numbers
    return {str(level): float(weights[met == str(level)].sum()) / total for level in declared}


@dataclass(frozen=True)
class LikelyEvent:
    """A run with the event.

    Attributes:
        run: Run.
        record: Its record.
        distance: Length of its vector without the seed: how far from the usual inputs it lies.
    """

    run: RiskRun
    record: RunRecord
    distance: float


def likeliest(folder: RiskFolder) -> list[LikelyEvent]:
    """Return the runs with the event whose inputs are the likeliest, the likeliest first.

    The density of a vector is the larger the shorter it is. All seeds are equally likely, so that
    the seed's component does not count.
    """
    found = [
        LikelyEvent(run, record, float(np.linalg.norm(np.delete(run.vector, SEED))))
        for run, record in folder.runs
        if folder.plan.criticality(run, record) >= 0.0
    ]
    return sorted(found, key=lambda one: one.distance)[:LISTED]
