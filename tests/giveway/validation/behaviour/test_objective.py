"""The objective of a fit for behaviour: less is more like the recorded people."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.validation.behaviour.comparison import Yardstick
from giveway.validation.behaviour.objective import FAILED, Objective
from giveway.validation.behaviour.replaying import replayed
from pedestrian_model import SIM

TIME = np.arange(100) / 10.0


@pytest.fixture
def walked_by_sim(recording) -> Yardstick:
    """People whom the model moved with some parameters: the best fit is known."""
    people = [
        np.column_stack([x + speed * TIME, np.full(100, y)])
        for x, y, speed in (
            (-5.0, 1.6, 1.2),
            (-3.0, 2.6, 1.3),
            (4.0, -2.2, -1.2),
            (6.0, -3.0, -1.4),
            (-2.0, 3.2, 1.1),
            (3.0, 3.6, -1.0),
        )
    ]
    return Yardstick([replayed(recording(*people), RunConfig(), parameters=SIM)])


def test_the_parameters_that_moved_people_are_better_than_others(walked_by_sim) -> None:
    objective = Objective([walked_by_sim], corridors=False)
    strange = replace(SIM, vehicle_strength=6000.0, vehicle_decay=0.5)
    assert objective(SIM) < 0.6 * objective(strange)


def test_the_parts_tell_what_the_value_is_made_of(walked_by_sim) -> None:
    objective = Objective([walked_by_sim], corridors=False)
    (likeness,) = objective.likenesses(SIM)
    assert objective(SIM) == pytest.approx(likeness.value)
    touching = replace(likeness, simulated=replace(likeness.simulated, contacts=3.0))
    assert touching.value == pytest.approx(likeness.value + 20.0 * 3.0 / likeness.near)


def test_speeds_in_corridors_count_beside_the_sites(walked_by_sim) -> None:
    """People of SIM walk too slowly in a corridor."""
    alone = Objective([walked_by_sim], corridors=False)(SIM)
    assert alone < Objective([walked_by_sim])(SIM) < FAILED


def test_people_who_stand_do_not_stop_a_fit(recording) -> None:
    standing = [np.full((100, 2), (x, 1.6 + 0.7 * x)) for x in (0.0, 1.0, 2.0, 3.0)]
    objective = Objective([Yardstick([recording(*standing)])], corridors=False)
    (likeness,) = objective.likenesses(SIM)
    assert likeness.recorded.acceleration == 0.0
    assert likeness.hardness == (1.0, 1.0)
