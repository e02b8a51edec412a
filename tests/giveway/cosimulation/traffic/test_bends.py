"""Where SUMO's cars are expected at its next step, against where SUMO then has them."""

from __future__ import annotations

import math
from typing import Any

import libsumo
import numpy as np
import pytest

from giveway.cosimulation.traffic.bends import Bends, sideways
from giveway.cosimulation.traffic.lane_paths import LanePathPool
from giveway.sumo.network.lanes import Lanes
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


def test_how_far_off_the_straight_line_a_lane_leads() -> None:
    """Lane path 0: 10 m east, then north; SUMO's metres are half of ours on its first lane."""
    points = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 30.0]])
    along = np.array([0.0, 10.0, np.inf])
    pool = LanePathPool(points, along, np.array([0, 3]), np.array([2]), np.array([5.0]))
    east, none = np.zeros(1), np.full(1, -1)
    on = np.zeros(1, dtype=np.int64)

    def off(position: float, reach: float, heading: float = 0.0, number: Any = on) -> float:
        where = np.array([position]), number, pool, np.array([reach])
        return float(sideways(east + heading, *where)[0])

    assert off(2.0, 5.0) == 0.0  # at x = 4 m, it stays on the first lane
    assert off(2.0, 10.0) == -4.0  # 6 m to the corner, 4 m north
    assert off(2.0, 10.0, math.pi) == pytest.approx(4.0)
    assert off(5.0, 50.0) == -50.0  # beyond its end it goes on north
    assert off(2.0, 10.0, number=none) == 0.0
