"""The vehicle as the controllers see it."""

from __future__ import annotations

import numpy as np
import pytest

from controller import LongitudinalModel, ParameterError


@pytest.mark.parametrize(
    ("name", "value"),
    [("mass", 0.0), ("mass", np.nan), ("friction", -1.0), ("time_step", np.inf)],
)
def test_refuses_what_is_no_vehicle(name, value):
    with pytest.raises(ParameterError, match=rf"{name} = .*expected.*\["):
        LongitudinalModel(**{name: value})
