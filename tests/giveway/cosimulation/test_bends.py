"""Where SUMO's cars are expected at its next step, against where SUMO then has them."""

from __future__ import annotations

import math

import libsumo
import numpy as np

from giveway.cosimulation.bends import Bends
from giveway.sumo.lanes import Lanes
from giveway.sumo.vehicles import SumoVehicles
from sumo_scenarios import find

DT = 0.05  # [s]


def aside(x: float, y: float, x_0: float, y_0: float, heading: float) -> float:
    """How far (x, y) is beside a line [m]."""
    return abs((y - y_0) * math.cos(heading) - (x - x_0) * math.sin(heading))


def test_between_sumo_s_steps_a_car_follows_its_lane() -> None:
    config = find("junction").config_file
    libsumo.start(["sumo", "-c", str(config), "--step-length", "1", "--no-step-log"])
    try:
        lanes = Lanes(libsumo, config)
        vehicles = SumoVehicles(libsumo, lambda function, *args: function(*args), lanes)
        bends = Bends(vehicles, DT, 20, 60)
        expected: dict[str, tuple[float, ...]] = {}
        off, straight = [], []
        for _ in range(120):
            libsumo.simulationStep()
            cars = vehicles.background()
            for x, y, name in zip(cars.x, cars.y, cars.ids, strict=True):
                if name in expected:
                    ours, theirs = expected[name][:3], expected[name][3:]
                    off.append(aside(x, y, *ours))
                    straight.append(aside(x, y, *theirs))
            expected = {}
            poses = np.full((1, len(cars.ids), 7), np.nan)
            bends.read(cars, np.arange(len(cars.ids)))
            bends.fill(poses, 0, 20)
            for i in np.flatnonzero(np.isfinite(poses[0, :, 0])):
                x, y, heading = poses[0, i, :3]
                half = cars.length[i] / 2
                front = x + half * math.cos(heading), y + half * math.sin(heading)
                expected[cars.ids[i]] = (*front, heading, cars.x[i], cars.y[i], cars.heading[i])
    finally:
        libsumo.close()
    assert len(off) > 30
    assert np.mean(straight) > 0.5
    assert np.mean(off) < 0.3  # the speeds differ, and a chord is no arc
