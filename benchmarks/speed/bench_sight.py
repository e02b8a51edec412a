"""Measures what cameras cost: who is in sight of three, and where people could be hidden.

Run: python benchmarks/speed/bench_sight.py

Thirty people and eight parked cars lie about an ego that drives at 8 m/s. The times are processor
times per control step, the least of ten blocks.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from giveway.ego.perception import OwnState, SensorSetup, Truth
from giveway.ego.perception.hidden_people import HidingPlaces
from giveway.ego.perception.sight import Sight, SightOptions
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath, Pose
from pedestrian_model import Crowd

if TYPE_CHECKING:
    from collections.abc import Callable

PEOPLE, CARS, SPEED, AGAIN = 30, 8, 8.0, 100
BODY = 2.25, 2.25, 1.8  # m: front, rear and width about the middle


def least(call: Callable[[], object]) -> float:
    """The least processor time [us] of a call."""
    call()
    blocks = []
    for _ in range(10):
        began = time.process_time()
        for _ in range(AGAIN):
            call()
        blocks.append((time.process_time() - began) / AGAIN)
    return 1e6 * min(blocks)


def main() -> None:
    """Print both times."""
    random = np.random.default_rng(1)
    places = random.uniform((0.0, -10.0), (50.0, 10.0), (PEOPLE, 2))
    velocity = random.uniform(-1.0, 1.0, (PEOPLE, 2))
    people = Crowd.create(places, velocity, 1.3, [[place + 10.0] for place in places])
    cars = [(10.0 + 6.0 * k, -3.0, 0.0, 0.0, *BODY) for k in range(CARS)]
    vehicles = np.array([(-2.25, 0.0, 0.0, SPEED, *BODY), *cars])
    tops = np.full(CARS + 1, 1.5), np.full(PEOPLE, 1.7)
    truth = Truth(people, vehicles, np.empty((0, 5)), 0.0, *tops)
    own = OwnState(Pose(0.0, 0.0, 0.0), SPEED, 0, VehicleShape(4.5, 1.8))
    sensor, ids = Sight(SensorSetup(0.05, 1, "ego"), SightOptions()), np.arange(PEOPLE)
    hiding = HidingPlaces(EgoPath.through([(0.0, 0.0), (200.0, 0.0)]), 0.3)
    print(f"in sight: {least(lambda: sensor.observe(truth, ids, own)):.0f} us")
    print(f"hiding places: {least(lambda: hiding.ahead(sensor, truth, 0, 0.0, SPEED)):.0f} us")


if __name__ == "__main__":
    main()
