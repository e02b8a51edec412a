"""When an inserted ego departs: at its time, or at one drawn from the seed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.cosimulation.entry.departure_time import departure_time


def departure(**settings: Any) -> float:
    (ego,) = RunConfig.model_validate(settings).each_ego()
    return departure_time(ego)


def test_a_time_is_kept() -> None:
    assert departure(ego={"depart_time": 12.3456}) == 12.3456
    assert departure() == 0.0


def test_a_window_is_drawn_from_uniformly_in_milliseconds() -> None:
    drawn = [departure(seed=seed, ego={"depart_time": (60, 120)}) for seed in range(400)]
    assert len(set(drawn)) > 390
    assert all(time == round(time, 3) for time in drawn)
    quarters = np.histogram(drawn, bins=4, range=(60.0, 120.0))[0]
    assert quarters.sum() == 400
    assert quarters.min() > 70


def test_it_depends_on_the_seed_and_the_egos_id_alone() -> None:
    ego = {"depart_time": [60.0, 120.0]}
    same = {
        departure(seed=3, ego=ego, controller=name, crowd={"pedestrians": count})
        for name, count in (("mpc", 0), ("pid-tuned", 5), ("mpc-paper", 20))
    }
    assert len(same) == 1
    assert departure(seed=3, ego=ego | {"id": "shuttle"}) not in same


@pytest.mark.parametrize("given", ["60,120", [60, 120], (60.0, 120.0)])
def test_a_window_is_a_pair_in_a_file_and_on_the_command_line(given: object) -> None:
    (ego,) = RunConfig.model_validate({"ego": {"depart_time": given}}).each_ego()
    assert ego.ego.depart_time == (60.0, 120.0)


@pytest.mark.parametrize("given", ["5,3", [1, 2, 3], [], "soon", -1.0, 1e8, [0.0, 1e8], True, None])
def test_what_is_neither_time_nor_window_is_refused(given: object) -> None:
    said = "expected a time, or the earliest and the latest one|not true or false"
    with pytest.raises(ValueError, match=said):
        RunConfig.model_validate({"ego": {"depart_time": given}})
