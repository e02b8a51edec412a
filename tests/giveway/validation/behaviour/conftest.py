"""Recordings that are made here, of people on given tracks and one car on a straight road."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.recordings import CITR, Recording, Tracks

if TYPE_CHECKING:
    from collections.abc import Callable

RATE = 10.0


def tracks(places: list[np.ndarray], body: tuple[float, float, float]) -> Tracks:
    """Return tracks of which each has a place at every instant, from 0 on."""
    velocity = [np.gradient(place, axis=0) * RATE for place in places]
    track = np.concatenate([np.full(len(place), i) for i, place in enumerate(places)])
    moving = np.concatenate(velocity)
    return Tracks(
        ids=tuple(str(i) for i in range(len(places))),
        kinds=("",) * len(places),
        track=track,
        frame=np.concatenate([np.arange(len(place)) for place in places]),
        position=np.concatenate(places),
        velocity=moving,
        heading=np.arctan2(moving[:, 1], moving[:, 0]),
        speed=np.hypot(moving[:, 0], moving[:, 1]),
        body=np.tile(body, (len(places), 1)),
    )


@pytest.fixture
def recording() -> Callable[..., Recording]:
    """Make a recording of people (T, 2) each, and a car that reaches x = 0 after 5 s."""

    def make(*people: np.ndarray, car_speed: float = 4.0) -> Recording:
        time = np.arange(len(people[0])) / RATE
        car = np.column_stack([car_speed * (time - 5.0), 0.0 * time])
        return Recording(
            name="made",
            file=Path("made.csv"),
            dataset=CITR,
            frame_rate=RATE,
            first_frame=0,
            frames=len(time),
            people=tracks(list(people), (0.0, 0.0, 0.0)),
            vehicles=tracks([car], (2.0, 2.0, 1.8)),
            defects=(),
        )

    return make
