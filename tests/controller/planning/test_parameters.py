"""Parameters of the planner: what is out of range is refused by name."""

from __future__ import annotations

import numpy as np
import pytest

from controller import ControllerError, ManoeuvreParameters, PlannerParameters


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"accelerations": ()}, "accelerations"),
        ({"accelerations": (-1.0,), "slowest": (0.0,)}, "accelerations"),
        ({"slowest": (0.0,)}, "slowest"),
        ({"jerk": 0.0}, "jerk"),
        ({"deceleration": -1.0}, "deceleration"),
        ({"precaution_weight": np.nan}, "precaution_weight"),
    ],
)
def test_parameters_out_of_range_are_refused_by_name(changes, name):
    with pytest.raises(ControllerError, match=name):
        ManoeuvreParameters(**changes)


@pytest.mark.parametrize(
    "changes", [{"horizon": 3}, {"reference_speed": 0.0}, {"effort_weight": -1.0}]
)
def test_a_planner_that_cannot_be_is_refused_by_name(changes):
    with pytest.raises(ControllerError, match=next(iter(changes))):
        PlannerParameters(**changes)
