"""Confirmatory differences: Holm's correction, and effects below the smallest of interest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from giveway.studies.definition import StudyDefinition
from giveway.studies.statistics import compare
from giveway.studies.statistics.confirmatory import confirmatory, holm, is_confirmatory

OUTCOME = {"metric": "stops", "smallest_effect": 1.0, "reason": "a stop is whole"}


def test_holms_steps_and_values_that_are_missing():
    corrected = holm(np.array([0.01, 0.04, math.nan, 0.03, 0.005]))
    assert_allclose(corrected, [0.03, 0.06, math.nan, 0.06, 0.02])
    assert_allclose(holm(np.array([0.5, 0.9])), [1.0, 1.0])
    assert holm(np.array([])).size == 0


@pytest.fixture
def differences(new_study):
    """The confirmatory rows of a study with one treatment per list of numbers of stops."""

    def rows(smallest_effect: float = 1.0, **numbers: list[float]):
        factors = {"controller": [*numbers, "base"]}
        study = new_study(factors).add("base", stops=np.zeros(12))
        for level, values in numbers.items():
            study.add(level, stops=values)
        outcome = OUTCOME | {"smallest_effect": smallest_effect}
        definition = StudyDefinition(name="s", factors=factors, primary_outcome=outcome)
        frame = compare(study.runs, study.design, study.comparison)
        assert is_confirmatory(frame, definition).sum() == len(numbers) < len(frame)
        return confirmatory(frame, definition).set_index("treatment")

    return rows


def test_an_interval_is_compared_with_the_smallest_effect(differences):
    wide = [0.5, 1.5, 2.5, 3.5] * 3
    rows = differences(a=[3.0, 4.0, 5.0] * 4, b=[0.1, 0.2, 0.3] * 4, c=wide, d=[9.0])
    found = rows["smaller_effects"].to_dict()
    assert found == {"a": "excluded", "b": "only these", "c": "excluded", "d": "N.A."}
    assert rows["verdict"].to_dict() == {"a": "worse", "b": "worse", "c": "worse", "d": "N.A."}
    rows = differences(2.0, a=wide, b=[-number for number in wide])
    assert set(rows["smaller_effects"]) == {"possible"}
    assert rows["verdict"].to_dict() == {"a": "worse", "b": "better"}


def test_the_verdict_takes_the_rows_of_the_outcome_alone(differences):
    some = [0.0, 0.9, 0.0, 2.1, -0.8, 1.1, 1.2, 1.3, 0.0, 1.4, 0.0, 0.0]
    alone = differences(a=some).loc["a"]
    assert alone["p_holm"] == alone["p_value"] <= 0.05
    assert alone["verdict"] == "worse"
    among = differences(a=some, **{f"n{i}": [1.0, -1.0] * 6 for i in range(4)}).loc["a"]
    assert among["p_holm"] == pytest.approx(5 * among["p_value"])
    assert among["verdict"] == "no difference shown"


def test_without_a_primary_outcome_all_is_exploratory(two_controllers):
    study = two_controllers({"stops": np.ones(5)}, {"stops": np.zeros(5)})
    frame = compare(study.runs, study.design, study.comparison)
    definition = StudyDefinition(name="s", factors={"controller": ["mpc", "pid"]})
    assert not is_confirmatory(frame, definition).any()
    assert confirmatory(frame, definition).empty
