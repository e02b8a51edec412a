"""The junction in real SUMO: signals, crossings, people and cars.

                 north
          w0 = c0 = w1
west --- c3       c1 --- c (zebra) --- east
          w3 = c2 = w2
                 south
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from xml.etree.ElementTree import Element

import pytest

from sumo_scenarios import find

Probe = Callable[..., dict[str, Any]]
Settings = Callable[..., dict[str, Any]]

ARMS = [f"centre_c{i}" for i in range(4)]


@pytest.fixture
def watch(probe: Probe) -> Probe:
    def run(seed: int) -> dict[str, Any]:
        return probe("watch_junction", find("junction").config_file, None, seed=seed)

    return run


def test_crossings_of_all_arms_have_signals_and_the_zebra_none(watch: Probe) -> None:
    seen = watch(seed=1)
    assert seen["signalised"] == ARMS
    assert seen["crossings"] == [*ARMS, "zebra_c0"]


@pytest.mark.parametrize("seed", [1, 7])
def test_dozens_of_people_use_every_crossing_and_none_on_red(watch: Probe, seed: int) -> None:
    seen = watch(seed=seed)
    assert 50 <= len(seen["departed"]) <= 120
    assert set(seen["used"]) == {*ARMS, "zebra_c0"}
    assert min(seen["used"].values()) >= 2
    assert seen["on_red"] == []


def test_cars_go_all_ways_and_nobody_collides(watch: Probe) -> None:
    seen = watch(seed=1)
    assert {"eastbound", "northbound", "southbound", "westbound"} < set(seen["cars"])
    assert len(seen["cars"]) >= 8  # of the twelve ways over the junction
    assert seen["teleports"] == 0
    assert seen["collisions"] == 0


def test_who_departs_when_is_a_matter_of_the_seed(watch: Probe) -> None:
    one, again, other = watch(seed=1), watch(seed=1), watch(seed=2)
    for kind in ("departed", "driven"):  # people, and cars, with their times
        assert one[kind] == again[kind]
        assert one[kind] != other[kind]


def test_the_step_is_a_tenth_of_a_second(probe: Probe) -> None:
    assert probe("load", find("junction").config_file)["step_length"] == 0.1


def test_the_ego_departs_at_any_instant_of_the_signals_cycle(
    settings: Settings, xml_of: Callable[..., Element]
) -> None:
    phases = xml_of("junction", "net.xml").findall("tlLogic/phase")
    earliest, latest = settings(find("junction"))["ego"]["depart_time"]
    assert latest - earliest == sum(float(phase.attrib["duration"]) for phase in phases)


@pytest.mark.parametrize(
    ("target", "crossing", "letter"),
    [
        ("east_out", ":centre_c1", "G"),  # straight on: people wait there meanwhile
        ("north_out", ":centre_c0", "g"),  # to both sides: people have green as well
        ("south_out", ":centre_c2", "g"),
    ],
)
def test_the_egos_turns_are_permissive_across_peoples_green(
    xml_of: Callable[..., Element], target: str, crossing: str, letter: str
) -> None:
    net = xml_of("junction", "net.xml")
    way = net.find(f"connection[@from='west_in'][@to='{target}'][@tl='centre']")
    walk = net.find(f"connection[@to='{crossing}'][@tl='centre']")
    assert way is not None
    assert walk is not None
    states = [phase.attrib["state"] for phase in net.findall("tlLogic/phase")]
    pairs = [
        tuple(state[int(link.attrib["linkIndex"])] for link in (way, walk)) for state in states
    ]
    driven = {walking for driving, walking in pairs if driving in "Gg"}
    assert {driving for driving, _ in pairs} == {letter, "y", "r"}
    assert ("G" in driven) == (letter == "g")
    assert ("r", "r") in pairs  # the junction is cleared


def test_the_egos_way_leads_over_the_signals_and_the_zebra(settings: Settings) -> None:
    ego = settings(find("junction"))["ego"]
    assert ego["route"] == ["west_in", "east_out", "far_east_out"]
    front = -120.0 + ego["depart_position"] + ego["travel_distance"]  # the way is straight
    assert front > 62.0 + 5.0  # the zebra's far side and a car's length
