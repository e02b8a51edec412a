"""The scripts of the dummies: the front meets the reference point at the hit point, to 1 cm."""

from __future__ import annotations

from math import cos, inf, sin
from pathlib import Path

import numpy as np
import pytest

from giveway.config.tables.scripted import ScriptedConfig
from giveway.crowd.motion.scripted import ScriptedWalk
from giveway.geometry.path import EgoPath
from giveway.ncap.plan import (
    HOLDER,
    course_name,
    road_of,
    runs_of,
    script_of,
    study_of,
    width_of,
)
from giveway.ncap.protocol import KMH, PROTOCOLS, Cell, Protocol, read_protocol
from giveway.ncap.turning import path_of
from pedestrian_model import Vehicles

STEP = 0.05


STRAIGHT = EgoPath.through([[0.0, 0.0], [1000.0, 0.0]])
LENGTH = 4.6


def hit_point(protocol: Protocol, cell: Cell, width: float, start: float) -> float:
    """Drive at the cell's speed; return where [%] the reference point meets the front.

    The car begins ``start`` [m] before the place at which the dummy sets out.
    """
    person, before = script_of(protocol, cell, width, LENGTH)
    entry, dummy, turn = ScriptedConfig(**person), protocol.dummy(cell.test), cell.test.turn
    walk, speed = ScriptedWalk(entry), cell.speed / KMH
    path = STRAIGHT if turn is None else path_of(turn, cell.speed)
    front, heading = entry.meet_x - speed * before - start, np.radians(entry.heading)
    towards = np.array([cos(heading), sin(heading)])
    place, seen = np.array([entry.x, entry.y]), []
    for _ in range(4000):
        pose = path.pose(front, LENGTH)
        c, s = cos(pose.heading), sin(pose.heading)
        way = abs(towards @ [c, s]), abs(towards @ [-s, c])
        half = (dummy.length * way[0] + dummy.width * way[1]) / 2.0
        off = place - [pose.x, pose.y]
        point = off - dummy.reference * towards
        seen.append((off @ [c, s] - half, point @ [-s, c]))
        if seen[-1][0] <= 0.0:
            break
        car = Vehicles.create(
            pose.x, pose.y, pose.heading, speed, front=0.0, rear=LENGTH, width=width
        )
        place, _ = walk.go_on(car, STEP)
        front += speed * STEP
    (gap, at), (gone, then) = seen[-2:]
    aside = at + gap / (gap - gone) * (then - at)
    return 100.0 * (0.5 - cell.test.comes_from * aside / width)


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


def test_a_turn_has_another_course_at_each_speed():
    protocol = read_protocol("euroncap-2023")
    turns = [cell for cell in protocol.cells if cell.test.turn is not None]
    found = {course_name(road_of(cell), cell.speed) for cell in turns}
    assert found == {"left turn 10", "left turn 15", "left turn 20", "right turn 10"}


def test_the_layer_of_the_tests_knows_nobody_in_hiding_unless_the_user_says_so(tmp_path):
    protocol = read_protocol("r152")
    runs = runs_of(protocol.cells[:1], (HOLDER, "mpc"))
    courses = {"open road": Path("open.sumocfg")}

    def speeds(car):
        levels = study_of("x", protocol, runs, car, courses, tmp_path, 1).factors["test"].values()
        return [level.get("safety", {}).get("hidden_speed") for level in levels]

    assert speeds({}) == [0.0, 0.0, None, None]
    assert speeds({"safety": {"hidden_speed": 0.5}}) == [None] * 4
    assert width_of({"vehicle": {"width": 1.7}}) == 1.7
    assert width_of({}) < inf
