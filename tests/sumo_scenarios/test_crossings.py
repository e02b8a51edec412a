"""The situations of the scenario crossings, as its network and its routes have them.

west -- zebra_c0 -- [signals: centre] -- east      the ego comes from the west and turns right
                          |
              island_c0 = w2 = island_c1           half of the road, the island, the other half
                          |
           . . . people of giveway's own . . .
                     bus stop
                          |
                        south
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from xml.etree.ElementTree import Element

import pytest

from sumo_scenarios import find

Xml = Callable[[str, str], Element]
Settings = Callable[..., dict[str, Any]]


@pytest.fixture
def net(xml_of: Xml) -> Element:
    return xml_of("crossings", "net.xml")


def link(net: Element, start: str, end: str) -> dict[str, str]:
    found = net.find(f"connection[@from='{start}'][@to='{end}']")
    assert found is not None
    return found.attrib


def points(net: Element, lane: str) -> list[tuple[float, ...]]:
    found = net.find(f".//lane[@id='{lane}']")
    assert found is not None
    return [tuple(map(float, point.split(","))) for point in found.attrib["shape"].split()]


def test_at_the_zebra_cars_give_way_and_people_do_not(net: Element) -> None:
    assert link(net, ":zebra_w0", ":zebra_c0")["state"] == "M"
    for start, end in (("west_in", "main_in"), ("main_out", "west_out")):
        assert link(net, start, end)["state"] == "m"
        assert "tl" not in link(net, start, end)


def test_the_ego_turns_on_a_green_that_people_have_as_well(
    net: Element, settings: Settings
) -> None:
    route = settings(find("crossings"))["ego"]["route"]
    turn = int(link(net, *route[1:3])["linkIndex"])
    walk = int(link(net, ":centre_w3", ":centre_c2")["linkIndex"])
    assert link(net, *route[1:3])["dir"] == "r"
    states = [phase.attrib["state"] for phase in net.findall("tlLogic/phase")]
    assert {state[turn] for state in states} == {"g", "y", "r"}
    assert ("g", "G") in {(state[turn], state[walk]) for state in states}
    left = int(link(net, "main_in", "north_out")["linkIndex"])
    assert {state[left] for state in states} == {"g", "y", "r"}  # the alternative


def test_the_island_parts_a_crossing_in_two_with_room_between(net: Element) -> None:
    halves = ("south_out", "island_c0"), ("south_in", "island_c1")
    for edge, crossing in halves:
        found = net.find(f"edge[@id=':{crossing}']")
        assert found is not None
        assert found.attrib["crossingEdges"] == edge
    assert link(net, ":island_w2", ":island_c0")["state"] == "M"
    assert link(net, ":island_c1", ":island_w2")["state"] == "M"
    kerbs = sorted(x for _, name in halves for x, _ in points(net, f":{name}_0"))
    assert kerbs[2] - kerbs[1] == pytest.approx(2.5, abs=0.1)  # [m] a pram and who pushes it


def test_nothing_is_marked_where_the_group_crosses(net: Element, settings: Settings) -> None:
    crowd = settings(find("crossings"))["crowd"]
    x_min, y_min, x_max, y_max = crowd["spawn_area"]
    marked = [
        y
        for edge in net.findall("edge[@function='crossing']")
        for _, y in points(net, f"{edge.attrib['id']}_0")
    ]
    assert all(y > y_max + 30.0 for y in marked)
    assert x_max < -6.5  # they start west of the western sidewalk, all of them
    assert x_min + crowd["walk"][0] > 6.5  # and end east of the eastern one
    assert min(y for _, y in points(net, "far_south_out_1")) < y_min


def test_a_bus_halts_on_the_egos_lane_and_people_wait_for_it(
    xml_of: Xml, settings: Settings
) -> None:
    (stop,) = xml_of("crossings", "add.xml").findall("busStop")
    ego = settings(find("crossings"))["ego"]
    assert stop.attrib["lane"] == f"{ego['route'][-1]}_{ego['lane']}"
    routes = xml_of("crossings", "rou.xml")
    assert routes.find(f"flow[@type='bus']/stop[@busStop='{stop.attrib['id']}']") is not None
    assert len(routes.findall(f"personFlow/walk[@busStop='{stop.attrib['id']}']")) == 2


def test_everybody_but_the_group_and_buses_departs_by_sumos_seed(
    xml_of: Xml, settings: Settings
) -> None:
    routes = xml_of("crossings", "rou.xml")
    flows = [*routes.findall("flow"), *routes.findall("personFlow")]
    (bus,) = (flow for flow in flows if flow.get("type") == "bus")
    assert float(bus.attrib["period"]) > 2.0 * float(bus.find("stop").attrib["duration"])
    flows.remove(bus)
    assert len(flows) > 15
    assert all(flow.attrib["period"].startswith("exp(") for flow in flows)
    assert settings(find("crossings"))["sumo"]["seed"] == "run"
