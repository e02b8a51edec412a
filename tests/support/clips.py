"""Clips in the dataset's own layout, made here: straight walkers, a cart, or the model itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RATE = 29.97  # [1/s] of the dataset's camera


@pytest.fixture
def write_clip() -> Callable[..., Path]:
    """Write a clip: tracks (T, n, 2) and velocities in OUR frame, an optional vehicle (T, 4)."""

    def write(
        folder: Path,
        name: str,
        position: np.ndarray,
        velocity: np.ndarray,
        vehicle: np.ndarray | None = None,
        first_frame: int = 101,
    ) -> Path:
        folder.mkdir(parents=True, exist_ok=True)
        people = folder / f"{name}_traj_ped_filtered.csv"
        lines = ["id,frame,label,x_est,y_est,vx_est,vy_est"]
        for i in range(position.shape[1]):
            for k in range(position.shape[0]):
                (x, y), (vx, vy) = position[k, i], velocity[k, i]
                if not np.isnan(x):  # y points down in the image
                    frame = first_frame + k
                    lines.append(f"{i + 1},{frame},ped,{x!r},{-y!r},{vx!r},{-vy!r}")
        people.write_text("\n".join(lines).replace("np.float64(", "").replace(")", "") + "\n")
        if vehicle is not None:
            rows = ["id,frame,label,x_est,y_est,psi_est,vel_est"]
            rows += [
                f"1,{first_frame + k},veh,{x},{-y},{-psi},{u}"
                for k, (x, y, psi, u) in enumerate(vehicle.tolist())
            ]
            beside = folder / f"{name}_traj_veh_filtered.csv"
            beside.write_text("\n".join(rows) + "\n")
        return people

    return write


@pytest.fixture
def straight_walks() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Positions and velocities (T, n, 2) of walkers at constant velocity."""

    def make(frames: int, start: list, velocity: list) -> tuple[np.ndarray, np.ndarray]:
        v = np.array(velocity, dtype=float)
        time = np.arange(frames)[:, None, None] / RATE
        return np.array(start, dtype=float) + time * v, np.broadcast_to(v, (frames, *v.shape))

    return make
