"""How persons accept gaps, as a scenario says it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import libsumo

from giveway.sumo.persons.gap_habits import GapHabit, GapHabits

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

PEOPLE = """
    <vType id="plain" vClass="pedestrian"/>
    <vType id="bold" vClass="pedestrian" jmIgnoreFoeProb="0.4" jmIgnoreFoeSpeed="3"
        jmTimegapMinor="0.5" impatience="0.3"/>
    <vType id="slow" vClass="pedestrian">
        <param key="pedestrian.timegap-crossing" value="5"/>
    </vType>
    <person id="a" type="plain" depart="0"><walk edges="A1B1"/></person>
    <person id="b" type="bold" depart="0"><walk edges="A1B1"/></person>
    <person id="c" type="slow" depart="0"><walk edges="A1B1"/></person>
    <person id="d" type="bold" depart="0"><param key="pedestrian.timegap-crossing" value="7"/>
        <walk edges="A1B1"/></person>
"""


def test_options_types_and_persons_are_heeded(scenario: Callable[..., Path]) -> None:
    config = scenario(PEOPLE)
    libsumo.start(["sumo", "-c", str(config), "--pedestrian.timegap-crossing", "1.5"])
    try:
        libsumo.simulationStep()
        habits = GapHabits(libsumo)
        found = {name: habits.of(name, libsumo.person.getTypeID(name)) for name in "abcd"}
    finally:
        libsumo.close()
    assert found["a"] == GapHabit(2.5, 0.0, 0.0, 0.0, 0.0)
    assert found["b"] == GapHabit(2.0, 0.3, 0.4, 3.0, 0.0)
    assert found["c"] == GapHabit(6.0, 0.0, 0.0, 0.0, 0.0)
    assert found["d"] == GapHabit(7.5, 0.3, 0.4, 3.0, 0.0)
