"""The remark on a vehicle that the controller's M and alpha do not describe."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from giveway.config import EgoRunConfig
from giveway.results.mismatch import remark

H = 0.05  # [s]
FORCE = np.repeat([2000.0, 0.0, -3000.0, 1000.0, -500.0, 3000.0, -2000.0], 20)  # [N]


def drive(mass, friction, *, exact=False, force=FORCE, start=4.0):
    """A run's ego whose vehicle moves as M v' + alpha v = u, by forward Euler or exactly."""
    decay = np.exp(-friction / mass * H)
    speed, position = [start], [0.0]
    for u in force:
        v, end = speed[-1], u / friction
        if exact:
            speed.append(end + (v - end) * decay)
            position.append(position[-1] + end * H + (v - end) * (1 - decay) * mass / friction)
        else:
            speed.append(v + H / mass * (u - friction * v))
            position.append(position[-1] + H * v)
    acceleration = np.diff(speed, prepend=start) / H
    track = SimpleNamespace(
        time=H * np.arange(len(speed)),
        speed=np.array(speed),
        position=np.array(position),
        acceleration=acceleration,
        force=np.append(force, 0.0),
    )
    return SimpleNamespace(id="ego", track=track, config=EgoRunConfig())


@pytest.mark.parametrize("exact", [False, True])
def test_the_models_own_car_is_no_mismatch_however_it_is_solved(exact):
    assert remark(drive(1000.0, 100.0, exact=exact), H, 0.0) == ""


def test_another_mass_is_named_with_what_fits():
    ego = drive(1500.0, 100.0)
    text = remark(ego, H, 0.0)
    assert "M = 1000 kg" in text
    assert "M = 1500 kg and alpha = 100 N.s/m fit better" in text
    assert text.endswith("giveway fmu identify fmi2 -o car.toml")


def test_what_the_controller_allows_for_is_no_mismatch():
    assert remark(drive(1500.0, 100.0), H, 1.0) == ""


def test_an_identified_vehicle_is_not_identified_again():
    text = remark(drive(2500.0, 100.0), H, 0.05)
    assert "0.05 m as identified" in text
    assert "giveway fmu check fmi2" in text
    assert "identify" not in text.replace("identified", "")


def test_the_pid_has_no_model():
    ego = drive(1500.0, 100.0)
    ego.config = EgoRunConfig(controller="pid")
    assert remark(ego, H, 0.0) == ""


@pytest.mark.parametrize("steps", [0, 1, 5, 14, 15, 16])
def test_a_run_that_ends_within_the_horizon_does_not_tell(steps):
    remark(drive(1500.0, 100.0, force=FORCE[:steps]), H, 0.0)


def test_a_drive_without_forces_names_no_mass():
    text = remark(drive(1500.0, 700.0, force=np.zeros(100), start=12.0), H, 0.0)
    assert "does not answer" in text
    assert "fit better" not in text
