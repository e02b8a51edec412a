"""People who walk by a script: when they set out, and that nothing stops them."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.config.tables.scripted import ScriptedConfig
from giveway.crowd.motion.scripted import Script, ScriptedWalk
from pedestrian_model import Vehicles

STEP = 0.05
NOBODY = Vehicles.empty()


def car(front: float, speed: float) -> Vehicles:
    return Vehicles.create(front - 2.5, 0.0, 0.0, speed, front=2.5, rear=2.5, width=2.0)


def walk(**settings) -> ScriptedWalk:
    usual = {"name": "dummy", "x": 10.0, "y": -4.0, "heading": 90.0, "speed": 2.0}
    return ScriptedWalk(ScriptedConfig(**(usual | settings)))


@pytest.mark.parametrize("distance", [0.25, 1.0, 3.0])
def test_time_and_distance_of_a_script_fit(distance):
    script = Script(speed=2.0, acceleration_distance=1.0, distance=20.0)
    walked, speed = script.at(script.time_at(distance))
    assert walked == pytest.approx(distance)
    assert speed == pytest.approx(min(2.0, (2.0 * 2.0 * distance) ** 0.5))


def test_without_a_meeting_it_sets_out_at_its_time():
    person = walk(begin=0.1, acceleration_distance=0.1)
    steps = [person.go_on(NOBODY, STEP) for _ in range(6)]
    assert [place.tolist() for place, _ in steps[:2]] == [[10.0, -4.0]] * 2
    assert steps[2][1] == pytest.approx([0.0, 1.0])  # 20 m/s^2 for 0.05 s
    assert steps[-1][0] == pytest.approx([10.0, -4.0 + 0.1 + 0.1 * 2.0])


def test_it_waits_for_a_vehicle_and_meets_it_between_two_steps():
    """Two metres take 1.5 s; the front has 1.52 s left at the next step but one."""
    person = walk(meet_after=2.0, meet_x=9.75)
    person.go_on(car(9.75 - 10.0 * 1.62, 10.0), STEP)
    place, _ = person.go_on(car(9.75 - 10.0 * 1.52, 10.0), STEP)
    assert place[1] == pytest.approx(-4.0 + 0.5 * 2.0 * 0.03**2)  # 0.03 s of 2 m/s^2
    for _ in range(29):
        person.go_on(NOBODY, STEP)
    place, velocity = person.go_on(NOBODY, 0.02)
    assert place == pytest.approx([10.0, -2.0])
    assert velocity == pytest.approx([0.0, 2.0])


@pytest.mark.parametrize("vehicle", [NOBODY, car(0.0, 0.0), car(12.0, 10.0)])
def test_it_stands_while_no_vehicle_comes_to_the_place(vehicle):
    person = walk(meet_after=2.0, meet_x=9.75)
    for _ in range(100):
        place, velocity = person.go_on(vehicle, STEP)
    assert place.tolist() == [10.0, -4.0]
    assert velocity.tolist() == [0.0, 0.0]


def test_a_vehicle_that_turns_on_its_way_is_expected_at_the_time_that_was_known():
    """Two metres take 1.5 s; it has 1.6 s left, turns, and the person sets out 0.1 s later."""
    person = walk(meet_after=2.0, meet_x=9.75)
    person.go_on(car(9.75 - 16.0, 10.0), STEP)
    turned = Vehicles.create(-5.0, 1.0, 0.2, 10.0)
    places = [person.go_on(turned, STEP)[0][1] for _ in range(3)]
    assert places[:1] == pytest.approx([-4.0])
    assert places[2] == pytest.approx(-4.0 + 0.5 * 2.0 * 0.1**2)


def test_a_vehicle_that_stops_is_waited_for():
    person = walk(meet_after=2.0, meet_x=9.75)
    person.go_on(car(9.75 - 16.0, 10.0), STEP)
    for _ in range(100):
        place, _ = person.go_on(car(0.0, 0.0), STEP)
    assert place.tolist() == [10.0, -4.0]


def test_it_stands_at_the_end_of_its_walk():
    person = walk(distance=1.0)
    for _ in range(100):
        place, velocity = person.go_on(NOBODY, STEP)
    assert place == pytest.approx([10.0, -3.0])
    assert np.all(velocity == 0.0)
