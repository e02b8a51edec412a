"""A fit finds what the data were made with, and says honestly what it is worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from giveway.errors import ConfigError, DatasetError
from giveway.validation import calibrate
from giveway.validation.calibrating import HeldOut, split
from pedestrian_model import SIM
from tests.giveway.validation.conftest import TRUTH


def test_it_finds_the_parameters_that_the_clips_were_made_with(clips) -> None:
    names = ("destination_gain", "vehicle_strength")
    found = calibrate(clips, SIM, names, own_pace=False, held_out=HeldOut(0.34))
    assert found.converged
    assert found.parameters.destination_gain == pytest.approx(300.0, rel=0.03)
    assert found.parameters.vehicle_strength == pytest.approx(1500.0, rel=0.06)
    assert replace(found.parameters, destination_gain=1.0, vehicle_strength=1.0) == replace(
        SIM, destination_gain=1.0, vehicle_strength=1.0
    ), "what was not named stays"
    assert found.test.after < 0.2 * found.test.before
    assert (len(found.training), len(found.held_out)) == (2, 1)


def test_the_same_seed_gives_the_same_bits(clips) -> None:
    first, second = (
        calibrate(clips, SIM, ("destination_gain",), held_out=HeldOut(seed=3), evaluations=12)
        for _ in range(2)
    )
    assert first.parameters == second.parameters
    assert (first.train, first.held_out) == (second.train, second.held_out)
    assert not first.converged
    assert first.evaluations <= 12


def test_a_fit_that_cannot_get_better_does_not_claim_to(clips) -> None:
    found = calibrate(clips, TRUTH, ("destination_gain",), own_pace=False, evaluations=30)
    assert not found.test.improves
    assert found.parameters.destination_gain == pytest.approx(300.0, rel=1e-3)


def test_clips_of_each_kind_are_held_out_before_a_second_of_any(clips) -> None:
    many = [replace(clips[0], name=f"{kind}_{n:02}") for kind in "abc" for n in range(6)]
    train, test = split(many, 0.33, seed=1)
    kinds = [clip.name[0] for clip in test]
    assert [kinds.count(kind) for kind in "abc"] == [2, 2, 2]
    assert len(train) == 12
    assert {c.name for c in train}.isdisjoint(c.name for c in test)
    other = split(many, 0.33, seed=2)[1]
    assert [c.name for c in other] != [c.name for c in test]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["vehicle_strenght"], "did you mean 'vehicle_strength'"),
        (["mass", "mass"], "mass is named twice"),
        ([], "at least one of"),
    ],
)
def test_what_cannot_be_fitted_is_refused(clips, names, said) -> None:
    with pytest.raises(ConfigError, match=said):
        calibrate(clips, SIM, names)


def test_a_parameter_that_starts_at_zero_cannot_be_scaled(clips) -> None:
    with pytest.raises(ConfigError, match="vehicle_strength starts at 0"):
        calibrate(clips, replace(SIM, vehicle_strength=0.0), ["vehicle_strength"])


def test_too_few_clips_to_hold_one_out(clips) -> None:
    with pytest.raises(DatasetError, match="1 is too few to hold 1 out"):
        calibrate(clips[:1], SIM, ["mass"])
    with pytest.raises(ConfigError, match=r"--held-out 1\.5"):
        calibrate(clips, SIM, ["mass"], held_out=HeldOut(1.5))


def test_the_closest_two_people_stand_beside_the_error(clips) -> None:
    """Who feels neither repulsion nor the vehicle passes closer to the others."""
    found = calibrate(clips, SIM, ("destination_gain",), evaluations=2)
    data, before, after = found.apart
    position = np.concatenate([clip.position[15:] for clip in clips])
    apart = np.linalg.norm(position[:, :, None] - position[:, None], axis=3)
    apart[:, np.arange(4), np.arange(4)] = np.inf
    assert data == pytest.approx(np.nanmin(apart))
    assert 0.2 < before < 4.0
    assert after > 0.2
