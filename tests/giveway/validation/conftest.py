"""Clips that the pedestrian model made."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.validation import CITR, Clip, read_clips
from pedestrian_model import SIM, Crowd, CrowdModel, VciParameters, Vehicles

if TYPE_CHECKING:
    from pathlib import Path


DT = 1 / 29.97


TRUTH = replace(SIM, destination_gain=300.0, vehicle_strength=1500.0)


def walk(parameters: VciParameters, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Four who cross before and behind a cart, until all stand at their destinations."""
    frames, rng = 480, np.random.default_rng(seed)
    start = np.array([[-2.0, -4.0], [1.0, -5.0], [4.0, -4.5], [7.0, -3.0]])
    start += rng.uniform(-0.5, 0.5, start.shape)
    goals = start + [0.0, 9.0]
    model = CrowdModel(parameters, DT)
    crowd = Crowd.create(start, np.zeros((4, 2)), parameters.desired_speed, list(goals[:, None]))
    cart = np.zeros((frames, 4))
    cart[:, 0], cart[:, 3] = -9.0 + 2.0 * DT * np.arange(frames), 2.0
    position, velocity = np.empty((frames, 4, 2)), np.empty((frames, 4, 2))
    for k in range(frames):
        position[k], velocity[k] = crowd.position, crowd.velocity
        model.advance(crowd, Vehicles.create(*cart[k], 1.0, 1.2, 1.2))
    return position, velocity, cart


@pytest.fixture
def clips(tmp_path: Path, write_clip) -> tuple[Clip, ...]:
    """Three clips that the model made with ``TRUTH``."""
    for number in (1, 2, 3):
        write_clip(tmp_path, f"made_{number:02}", *walk(TRUTH, number))
    return read_clips(tmp_path, CITR)
