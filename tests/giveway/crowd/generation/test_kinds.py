"""Kinds of pedestrians: shares and walking speeds as measured."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import PeopleConfig
from giveway.crowd.generation.kinds import desired_speeds, draw_kinds

MANY = 20_000


def test_kinds_are_drawn_by_their_shares_and_the_rest_are_adults() -> None:
    people = PeopleConfig(elderly=0.2, distracted=0.3)
    kinds = np.array(draw_kinds(people, MANY, np.random.default_rng(1)))
    shares = {name: float(np.mean(kinds == name)) for name in np.unique(kinds)}
    assert shares == pytest.approx({"adult": 0.5, "elderly": 0.2, "distracted": 0.3}, abs=0.015)
    everybody = draw_kinds(PeopleConfig(child=1.0), 5, np.random.default_rng(1))
    assert everybody == ("child",) * 5


def test_without_a_mixture_there_are_no_kinds_and_no_draws() -> None:
    random = np.random.default_rng(1)
    assert draw_kinds(PeopleConfig(), 3, random) == ("", "", "")
    assert random.random() == np.random.default_rng(1).random()


@pytest.mark.parametrize(
    ("kind", "mean", "slow"),
    [  # the mean, and the 15th percentile where one is published [m/s]
        ("", 1.394, 1.394 - 0.26 * 1.036),
        ("adult", 1.394, 1.394 - 0.26 * 1.036),
        ("elderly", 3.81 * 0.3048, 3.02 * 0.3048),  # Gates et al. 2006
        ("child", 3.81 * 0.3048, 3.02 * 0.3048),
        ("distracted", 1.394 / 1.18, (1.394 - 0.26 * 1.036) / 1.18),  # Thompson et al. 2013
        ("hurried", 1.61, 1.61 - 0.26 * 1.036),  # Weidmann 1993
    ],
)
def test_each_kind_walks_as_was_measured(kind: str, mean: float, slow: float) -> None:
    speeds = desired_speeds(CrowdConfig(), (kind,) * MANY, np.random.default_rng(2))
    assert speeds.mean() == pytest.approx(mean, abs=0.015)
    assert np.percentile(speeds, 15.0) == pytest.approx(slow, abs=0.02)
    assert speeds.min() >= 0.5
    assert speeds.max() <= 2.2


def test_the_bounds_of_desired_speeds_are_an_option() -> None:
    drawn = {}
    for bounds in ((1.2, 1.5), (0.1, 2.5)):
        config = CrowdConfig(desired_speed_bounds=bounds, desired_speed_sd=0.4)
        drawn[bounds] = desired_speeds(config, ("",) * MANY, np.random.default_rng(2))
    assert 1.2 <= drawn[1.2, 1.5].min() < drawn[1.2, 1.5].max() <= 1.5
    assert drawn[0.1, 2.5].min() < 0.5
    assert drawn[0.1, 2.5].max() > 2.2
