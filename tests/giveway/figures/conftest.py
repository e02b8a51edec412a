"""A plausible run without a simulation: an ego that gives way to a crossing crowd."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.run_data.tracks import CrowdTrack, EgoTrack

DT = 0.05  # [s]
BODY_RADIUS = 0.27  # [m]
SHAPE = VehicleShape()

if TYPE_CHECKING:
    from collections.abc import Callable

Run = tuple[EgoTrack, CrowdTrack]
PLACE = ("time", "position", "front_x", "front_y", "heading")
NUMBERS = (*PLACE, "speed", "acceleration", "force", "gap", "reference_speed")


def drive_through_crowd(pedestrians: int, seed: int, controller: str, goal: float = 40.0) -> Run:
    """A first-order car along +x; walkers towards +y; the reference speed of the buffer."""
    rng = np.random.default_rng(seed)
    start = rng.uniform((16.0, -14.0), (34.0, -3.0), (pedestrians, 2))
    velocity = rng.normal((0.0, 1.4), (0.06, 0.26), (pedestrians, 2))
    position, speed, acceleration = 0.0, 4.0, 0.0
    egos, steps, indices, states = [], [], [], []
    k = 0
    while position < goal and k < 1200:
        place = start + k * DT * velocity
        here = np.flatnonzero(place[:, 1] < start[:, 1] + 30.0)
        ahead = place[here, 0] - (position + 2.5)
        lane = (ahead > 0.0) & (np.abs(place[here, 1]) < 1.25)
        gap = ahead[lane].min(initial=np.inf)
        reference = 4.0 * np.clip((gap - 8.0) / 10.0, 0.0, 1.0)
        acting = "mpc" if controller == "mpc" and gap > 8.0 else "pid"
        acceleration = np.clip((reference - speed) * (1.5 if acting == "mpc" else 4.0), -6.0, 2.0)
        force = 1000.0 * acceleration + 100.0 * speed
        pose = (position + 2.5, 0.0, 0.0)
        row = (k * DT, position, *pose, speed, acceleration, force, gap, reference)
        egos.append((*row, acting))
        steps.append(np.full(here.size, k))
        indices.append(here)
        states.append(np.hstack((place[here], velocity[here])))
        speed = max(0.0, speed + acceleration * DT)
        position += speed * DT
        k += 1
    numbers = np.array([row[:10] for row in egos], dtype=float).T
    acting = np.array([row[10] for row in egos])
    nothing = np.full(acting.size, np.inf)
    ego = EgoTrack(
        **dict(zip(NUMBERS, numbers, strict=True)),
        vehicle_gap=nothing,
        stop_gap=nothing,
        controller=acting,
        reason=np.where(acting == "mpc", "optimal", "infeasible"),
        solver_status=np.full(acting.size, ""),
        waits_for=np.full(acting.size, ""),
        solver_iterations=np.zeros(acting.size, dtype=np.int64),
    )
    crowd = CrowdTrack(
        np.concatenate(steps),
        np.concatenate(indices),
        *np.concatenate(states).T,
        ids=tuple(f"ped{i}" for i in range(pedestrians)),
    )
    return ego, crowd


@pytest.fixture(scope="session")
def run() -> Callable[..., Run]:
    return drive_through_crowd
