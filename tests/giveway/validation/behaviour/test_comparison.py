"""The comparison of distributions: distances, noise floors and their ratios."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.errors import DatasetError
from giveway.validation.behaviour import compare
from giveway.validation.behaviour.comparison import LEVELS, Distribution, floors_of
from giveway.validation.behaviour.comparison import distributions as with_floors
from giveway.validation.behaviour.measures import ALL, Behaviour, Samples

PEOPLE = 40


def behaviour(values: np.ndarray) -> Behaviour:
    """Return a behaviour in which each person has one sample of every measure."""
    person = np.arange(PEOPLE)
    return Behaviour(
        {each.name: Samples(values, person) for each in ALL},
        np.zeros(PEOPLE, dtype=bool),
        np.ones(PEOPLE, dtype=np.int64),
        np.zeros(PEOPLE, dtype=np.int64),
    )


def distributions(recorded: Behaviour, simulated: Behaviour) -> tuple[Distribution, ...]:
    return with_floors(recorded, simulated, floors_of(recorded))


@pytest.fixture
def recorded() -> Behaviour:
    return behaviour(np.random.default_rng(1).normal(size=PEOPLE))


def test_a_shift_is_the_distance(recorded) -> None:
    values = recorded.samples["speed"].value
    for found in distributions(recorded, behaviour(values + 1.5)):
        assert found.distance == pytest.approx(1.5)
        assert found.ratio == pytest.approx(1.5 / found.floor)


def test_the_recorded_people_are_at_no_distance_from_themselves(recorded) -> None:
    assert [found.ratio for found in distributions(recorded, recorded)] == [0.0] * 8


def test_the_floor_is_what_two_halves_differ_by(recorded) -> None:
    floor = distributions(recorded, recorded)[0].floor
    assert 0.1 < floor < 0.6  # of normal values, 20 a half
    assert distributions(recorded, recorded)[0].floor == floor


def test_the_band_of_the_halves_holds_the_recorded_quantiles(recorded) -> None:
    found = distributions(recorded, recorded)[0]
    middle = np.quantile(found.recorded, LEVELS)[10:91]
    assert (found.low[10:91] <= middle).all()
    assert (middle <= found.high[10:91]).all()


def test_a_measure_without_simulated_values_has_no_distance(recorded) -> None:
    nobody = behaviour(np.zeros(PEOPLE))
    nobody.samples["speed"] = Samples(np.empty(0), np.empty(0, dtype=np.int64))
    assert np.isnan(distributions(recorded, nobody)[0].ratio)


def test_a_recording_without_people_changes_nothing(recording) -> None:
    time = np.arange(100) / 10.0
    people = [np.column_stack([0.3 * i * time, np.full(100, 1.6 + i)]) for i in range(4)]
    full = recording(*people)
    empty = replace(full, people=full.people.only(np.zeros(4, dtype=bool)))
    one, two = compare([full], RunConfig()), compare([full, empty], RunConfig())
    assert two.recordings == 2
    assert two.near == one.near == 4
    assert two.summary.equals(one.summary)
    assert two.counts == one.counts


def test_too_few_people_near_a_vehicle(recording) -> None:
    far = np.column_stack([np.arange(100) / 10.0, np.full(100, 50.0)])
    with pytest.raises(DatasetError, match=r"of 1 people 0 are within 4 m .*expected at least 4"):
        compare([recording(far)], RunConfig())
