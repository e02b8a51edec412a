"""Parameters of the pedestrian model: presets and ranges."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, fields, replace

import pytest

from pedestrian_model import (
    SIM,
    TABLE2,
    ParameterError,
    VciParameters,
)


def test_presets_are_frozen_and_differ_in_the_strengths_only():
    assert VciParameters() == SIM
    assert (TABLE2.repulsion_strength, TABLE2.navigation_strength) == (30.028, 41.875)
    assert TABLE2.collision_stiffness == 982.125
    assert (
        replace(
            TABLE2,
            repulsion_strength=301.028,
            navigation_strength=410.875,
            collision_stiffness=9825.125,
        )
        == SIM
    )
    with pytest.raises(FrozenInstanceError):
        SIM.mass = 70.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": 0.0}, "mass = 0.0, expected a number > 0"),
        ({"collision_stiffness": -1.0}, "collision_stiffness = -1.0, expected a number >= 0"),
        ({"repulsion_anisotropy": 1.5}, "<= 1"),
        ({"navigation_anisotropy": 5.0}, "<= 4"),
        ({"max_speed": float("nan")}, "max_speed = nan"),
        ({"desired_speed": "fast"}, "desired_speed = 'fast'"),
        ({"influence_low": 700.0}, "influence_low = 700.0 N, expected less than"),
    ],
)
def test_parameters_out_of_range_are_refused_by_name_and_value(change, message):
    with pytest.raises(ParameterError, match=message):
        replace(SIM, **change)


SHARES = {"repulsion_anisotropy", "navigation_anisotropy", "vehicle_anisotropy"}


@pytest.mark.parametrize("name", [field.name for field in fields(SIM)])
def test_no_parameter_takes_a_number_that_no_person_has(name):
    """A force of 1e9 N, a gap of 1e-9 m: what was meant is another unit, or another key."""
    with pytest.raises(ParameterError, match=rf"{name} = 1000000000.0, expected .*: \w+"):
        replace(SIM, **{name: 1e9})
    if name not in SHARES:
        with pytest.raises(ParameterError, match=rf"{name} = 1e-09, expected .*: \w+"):
            replace(SIM, **{name: 1e-9})


def test_a_parameter_that_may_be_zero_says_so_with_the_reason():
    with pytest.raises(ParameterError) as refused:
        replace(SIM, navigation_strength=1e9)
    assert str(refused.value) == (
        "navigation_strength = 1000000000.0, expected 0 or a number >= 0.01 and <= 10000: people "
        "are moved by some hundred newtons, and 400 N are a_max for 80 kg already"
    )
    assert replace(SIM, navigation_strength=0.0, vehicle_clearance=0).navigation_strength == 0.0
