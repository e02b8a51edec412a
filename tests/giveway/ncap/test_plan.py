"""The scripts of the dummies: the front meets the reference point at the hit point, to 1 cm."""

from __future__ import annotations

from math import cos, inf, sin

import numpy as np
import pytest

from giveway.config.tables.scripted import ScriptedConfig
from giveway.crowd.motion.scripted import ScriptedWalk
from giveway.ncap.plan import HOLDER, runs_of, script_of, study_of, width_of
from giveway.ncap.protocol import KMH, PROTOCOLS, Cell, Protocol, read_protocol
from pedestrian_model import Vehicles

STEP = 0.05


def hit_point(protocol: Protocol, cell: Cell, width: float, start: float) -> float:
    """Drive at the cell's speed; return where [%] the reference point meets the front.

    The car begins ``start`` [m] before the place at which the dummy sets out.
    """
    person, before = script_of(protocol, cell, width)
    entry, dummy = ScriptedConfig(**person), protocol.dummy(cell.test)
    walk, speed = ScriptedWalk(entry), cell.speed / KMH
    front = entry.meet_x - speed * before - start
    along = cell.test.walks == "along"
    half = (dummy.length if along else dummy.width) / 2.0
    place, velocity = np.array([entry.x, entry.y]), np.zeros(2)
    for _ in range(4000):
        gap = place[0] - half - front
        closing = speed - velocity[0]
        if gap <= closing * STEP:
            place = place + gap / closing * velocity
            break
        vehicle = Vehicles.create(front, 0.0, 0.0, speed, front=0.0, rear=4.0, width=width)
        place, velocity = walk.go_on(vehicle, STEP)
        front += speed * STEP
    heading = np.radians(entry.heading)
    point = place - dummy.reference * np.array([cos(heading), sin(heading)])
    side = -1.0 if cell.test.walks == "from the left" else 1.0
    return 100.0 * (0.5 + side * point[1] / width)


@pytest.mark.parametrize("name", PROTOCOLS)
@pytest.mark.parametrize("width", [1.6, 2.0, 2.55])
def test_at_constant_speed_each_cell_is_hit_within_a_centimetre(name, width):
    protocol = read_protocol(name)
    for number, cell in enumerate(protocol.cells):
        found = hit_point(protocol, cell, width, start=1.0 + 0.37 * (number % 7))
        assert abs(found - cell.hit) / 100.0 * width < 0.01, cell.label


def test_the_dummy_has_its_speed_over_the_distance_of_the_protocol():
    """CPFA: 8 km/h after 1.5 m, so that 1.65 m/s^2."""
    protocol = read_protocol("euroncap-2026")
    cell = next(one for one in protocol.cells if one.key == ("CPFA", 50, 30))
    person, _ = script_of(protocol, cell, 1.8)
    walk = ScriptedWalk(ScriptedConfig(**(person | {"meet_after": None})))
    places = [walk.go_on(Vehicles.empty(), STEP) for _ in range(60)]
    speeds = [float(np.hypot(*velocity)) for _, velocity in places]
    walked = [6.0 - float(place[1]) for place, _ in places]
    assert speeds[0] == pytest.approx(1.646 * STEP, rel=1e-3)
    assert max(speeds) == pytest.approx(8.0 / KMH)
    first = next(way for way, speed in zip(walked, speeds, strict=True) if speed == max(speeds))
    assert first == pytest.approx(1.5, abs=0.12)


def test_every_road_and_speed_is_driven_without_a_person_too():
    protocol = read_protocol("euroncap-2026")
    runs = runs_of(protocol.cells, (HOLDER, "mpc"))
    alone = [(run.driver, run.road, run.speed) for run in runs if run.cell is None]
    assert len(alone) == len(set(alone)) == 2 * (8 + 6)
    assert len(runs) == 2 * (110 + 14)
    assert len({run.label for run in runs}) == len(runs)


def test_the_layer_of_the_tests_knows_nobody_in_hiding_unless_the_user_says_so(tmp_path):
    protocol = read_protocol("r152")
    runs = runs_of(protocol.cells[:1], (HOLDER, "mpc"))
    courses = {"open road": tmp_path / "open.sumocfg"}

    def speeds(car):
        levels = study_of("x", protocol, runs, car, courses, 1).factors["test"].values()
        return [level.get("safety", {}).get("hidden_speed") for level in levels]

    assert speeds({}) == [0.0, 0.0, None, None]
    assert speeds({"safety": {"hidden_speed": 0.5}}) == [None] * 4
    assert width_of({"vehicle": {"width": 1.7}}) == 1.7
    assert width_of({}) < inf
