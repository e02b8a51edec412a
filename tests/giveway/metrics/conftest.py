"""Tracks made by hand: an ego on a path, pedestrians in straight lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from numpy.typing import NDArray

from giveway.run_data.tracks import CrowdTrack, EgoTrack

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Column = NDArray[np.float64]


def make_ego(
    time: Column,
    front: Column | None = None,
    heading: Column | float = 0.0,
    speed: Column | float = 0.0,
    **columns: Column | Sequence[str],
) -> EgoTrack:
    count = len(time)

    def full(value: Column | float) -> Column:
        return np.full(count, value, dtype=float)

    front = np.zeros((count, 2)) if front is None else front
    travelled = np.append(0.0, np.cumsum(np.hypot(*np.diff(front, axis=0).T)))
    filled = {
        "time": np.asarray(time, dtype=float),
        "position": travelled,
        "front_x": front[:, 0].copy(),
        "front_y": front[:, 1].copy(),
        "heading": full(heading),
        "speed": full(speed),
        "acceleration": full(0.0),
        "force": full(0.0),
        "gap": full(np.inf),
        "reference_speed": full(4.0),
        "vehicle_gap": full(np.inf),
        "stop_gap": full(np.inf),
        "controller": np.full(count, "mpc"),
        "reason": np.full(count, "optimal"),
        "solver_status": np.full(count, "solved"),
        "waits_for": np.full(count, ""),
        "solver_iterations": np.zeros(count, dtype=np.int64),
    }
    return EgoTrack(**(filled | {name: np.asarray(column) for name, column in columns.items()}))


def straight_ego(time: Column, speed: float, x: float = 0.0) -> EgoTrack:
    """Along +x; the front bumper is at ``x`` at time 0."""
    front = np.column_stack((x + speed * np.asarray(time), np.zeros(len(time))))
    return make_ego(time, front, 0.0, speed)


def make_crowd(*walks: tuple[int, Sequence[Sequence[float]]]) -> CrowdTrack:
    """Each walk: the step of its first record, and its rows of x, y, vx, vy."""
    records = [
        (first + row, pedestrian, *state)
        for pedestrian, (first, states) in enumerate(walks)
        for row, state in enumerate(states)
    ]
    rows = np.array(sorted(records), dtype=float).reshape(-1, 6)
    return CrowdTrack(
        rows[:, 0].astype(np.int64),
        rows[:, 1].astype(np.int64),
        *rows[:, 2:].T,
        ids=tuple(f"ped{i}" for i in range(len(walks))),
    )


def straight_walk(
    time: Column, place: Sequence[float], velocity: Sequence[float]
) -> tuple[int, Column]:
    """From ``place`` at the time 0, recorded at every instant of ``time``."""
    time = np.asarray(time)
    states = np.empty((time.size, 4))
    states[:, :2] = np.asarray(place) + time[:, None] * np.asarray(velocity)
    states[:, 2:] = velocity
    return 0, states


@pytest.fixture(scope="session")
def ego() -> Callable[..., EgoTrack]:
    return make_ego


@pytest.fixture(scope="session")
def driving() -> Callable[..., EgoTrack]:
    return straight_ego


@pytest.fixture(scope="session")
def crowd() -> Callable[..., CrowdTrack]:
    return make_crowd


@pytest.fixture(scope="session")
def walking() -> Callable[..., tuple[int, Column]]:
    return straight_walk
