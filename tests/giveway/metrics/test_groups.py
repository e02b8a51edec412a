"""The crowd's records by pedestrian, compared with pandas."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.tracks import CrowdTrack


def crowd(seed: int, people: int, instants: int) -> CrowdTrack:
    """Records in time order, of whom half are there at each instant; the last one never is."""
    random = np.random.default_rng(seed)
    there = random.random((instants, people)) < 0.5
    there[:, -1] = False
    step, who = np.nonzero(there)
    x, y, vx, vy = random.normal(size=(4, len(step)))
    return CrowdTrack(step, who, x, y, vx, vy, tuple(f"ped{i}" for i in range(people)))


@given(st.integers(0, 1000), st.integers(2, 6), st.integers(1, 12))
def test_totals_and_minima_are_those_of_pandas(seed: int, people: int, instants: int) -> None:
    track = crowd(seed, people, instants)
    groups = PedestrianGroups(track)
    table = pd.DataFrame({"who": track.pedestrian, "x": track.x, "step": track.step})
    by_person = table.groupby("who")
    expected = by_person["x"].sum().reindex(range(people)).to_numpy()
    np.testing.assert_allclose(groups.total(track.x), expected, atol=1e-12)
    least = groups.at(track.step.astype(float), groups.first_minimum(track.x))
    first = table.loc[by_person["x"].idxmin(), "step"].set_axis(by_person["x"].sum().index)
    np.testing.assert_array_equal(least, first.reindex(range(people)).to_numpy())


def test_of_equal_values_the_earliest_counts() -> None:
    track = crowd(1, 2, 10)
    groups = PedestrianGroups(track)
    first = groups.at(track.step.astype(float), groups.first_minimum(np.ones(track.x.size)))
    assert first[0] == track.step[0]
    assert np.isnan(first[1])


def test_distances_are_walked_from_record_to_record() -> None:
    track = CrowdTrack(
        step=np.array([0, 0, 1, 1, 5]),
        pedestrian=np.array([0, 1, 0, 1, 0]),
        x=np.array([0.0, 9.0, 3.0, 9.0, 3.0]),
        y=np.array([0.0, 9.0, 4.0, 9.5, 0.0]),
        vx=np.zeros(5),
        vy=np.zeros(5),
        ids=("a", "b"),
    )
    assert PedestrianGroups(track).walked(track) == pytest.approx([0.0, 0.0, 5.0, 0.5, 4.0])
