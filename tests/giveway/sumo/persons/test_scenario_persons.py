"""The scenario's own persons, taken over and handed back in real SUMO.

The streets of the cities, 100 m apart (sidewalks on both sides):

  A1 --A1B1--> B1 --B1C1--> C1        north: A1B1 ... lead east, B1B2 ... north
                                      A1B1 may be walked from B1 to A1 as well
"""

from __future__ import annotations

import itertools
import math
import random
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

from giveway.sumo.persons.scenario_persons import walked

if TYPE_CHECKING:
    from pathlib import Path

Look = Callable[..., Any]

EAST_AND_NORTH = '<walk edges="A1B1 B1C1 C1C2" arrivalPos="30"/>'
PLAN = f"""
    <vType id="guest" vClass="pedestrian" desiredMaxSpeed="1.2"/>
    <person id="a" type="guest" depart="0" departPos="10" color="255,128,0">
        <param key="home" value="number 7"/>
        {EAST_AND_NORTH}
        <stop edge="C1C2" duration="6" actType="look around"/>
        <walk edges="C1C2" arrivalPos="60"/>
    </person>"""


def person(walk: str, position: float = 10.0, name: str = "a") -> str:
    return f'<person id="{name}" depart="0" departPos="{position}">{walk}</person>'


def people(count: int) -> str:
    """Persons who walk, stop and walk again, at random; some with speeds of their own."""
    draw = random.Random(7)
    row, column = "0123", "ABCD"
    streets = [f"{c}{a}{c}{b}" for c in column for a, b in itertools.pairwise(row)]
    streets += [f"{a}{r}{b}{r}" for r in row for a, b in itertools.pairwise(column)]
    streets += [street[2:] + street[:2] for street in streets]
    plans = []
    for i in range(count):
        a, b, c = (draw.choice(streets) for _ in range(3))
        own = draw.choice(["", "", 'speed="1.6"', 'duration="200"'])
        plan = f'<walk from="{a}" to="{b}" {own}/>'
        if i % 3 == 0:
            plan += f'<stop edge="{b}" duration="5"/><walk from="{b}" to="{c}"/>'
        plans.append(f'<person id="p{i}" depart="{i / 5}">{plan}</person>')
    return "".join(plans)


def trips(folder: Path) -> dict[str, ET.Element]:
    return {e.attrib["id"]: e for e in ET.parse(folder / "trips.xml").getroot().iter("personinfo")}


def without_header(file: Path) -> str:
    return re.sub(r"<!--.*?-->", "", file.read_text(), count=1, flags=re.DOTALL)


def cars(seconds: float) -> str:
    """Cars on three ways through the city."""
    flows = '<vType id="car" sigma="0.5"/>'
    for i, (a, b) in enumerate([("A1B1", "C1D1"), ("D2C2", "B2A2"), ("B0B1", "B2B3")]):
        flow = f'<flow id="f{i}" type="car" begin="0" end="{seconds}" period="6"'
        flows += f'{flow} from="{a}" to="{b}" departLane="best"/>'
    return flows


def test_a_walker_is_told_as_sumo_walks_it(look: Look) -> None:
    seen = look("take", "signals", PLAN, time=20.0)
    assert seen["edges"] == ["A1B1", "B1C1", "C1C2"]
    assert seen["lane"] == "A1B1_0"
    assert seen["arrival_position"] == 30.0
    assert seen["stages_left"] == 2
    assert seen["type"] == "guest"
    assert seen["heading"] == pytest.approx(0.0, abs=0.3)
    assert 0.0 < seen["speed"] <= seen["desired_speed"]
    assert seen["desired_speed"] == pytest.approx(1.2, rel=0.5)


def test_edges_that_are_behind_a_walker_are_not_told(look: Look) -> None:
    seen = look("take", "bare", PLAN, time=120.0)
    assert seen["edges"] == ["B1C1", "C1C2"]


def test_a_walk_that_passes_twice_is_told_by_the_walkers_place(look: Look) -> None:
    round_trip = '<walk edges="A1B1 B1B2 B2A2 A2A1 A1B1 B1C1"/>'
    assert len(look("take", "bare", person(round_trip), time=30.0)["edges"]) == 6
    assert len(look("take", "bare", person(round_trip), time=320.0)["edges"]) == 2


def test_a_walk_without_a_way_is_told_from_the_nearest_edge(look: Look) -> None:
    """SUMO walks on across a junction without a footpath, but cannot say how far it is."""
    round_trip = '<walk edges="A1B1 B1B2 B2A2 A2A1 A1B1 B1C1"/>'
    assert len(look("take", "islands", person(round_trip), time=30.0)["edges"]) == 6


@pytest.mark.parametrize(
    ("walk", "speed"),
    [
        ('<walk edges="A1B1 B1C1" speed="0.7"/>', 0.7),
        ('<walk edges="A1B1 B1C1" speed="2.5"/>', 2.5),
        ('<walk edges="A1B1" arrivalPos="70" duration="100"/>', 0.6),
    ],
)
def test_a_walk_with_its_own_speed_keeps_it(look: Look, walk: str, speed: float) -> None:
    assert look("take", "signals", person(walk), time=5.0)["desired_speed"] == pytest.approx(speed)


@pytest.mark.parametrize(
    "plan",
    [
        '<stop edge="A1B1" duration="60"/><walk from="A1B1" to="B1C1"/>',
        '<ride from="A1B1" to="B1C1" lines="none"/>',
    ],
)
def test_who_does_not_walk_is_left_alone(look: Look, plan: str) -> None:
    assert look("take", "signals", person(plan), time=20.0) is None


def test_who_has_not_departed_is_left_alone(look: Look) -> None:
    later = f'<person id="a" depart="60">{EAST_AND_NORTH}</person>'
    assert look("take", "signals", later, time=20.0) is None


def test_persons_that_giveway_added_are_left_alone(look: Look) -> None:
    others = person(EAST_AND_NORTH, name="b")
    assert look("ours", "signals", person(EAST_AND_NORTH) + others) == {"ids": ["b"], "taken": None}


def test_everything_of_a_person_survives(look: Look, tmp_path: Path) -> None:
    seen = look("hand_back", "signals", PLAN, place=("B1C1", 20.0), time=20.0)
    assert seen["handed_back"]
    assert seen["type"] == "guest"
    assert seen["color"] == [255, 128, 0, 255]
    assert seen["home"] == "number 7"
    assert [stage[0] for stage in seen["stages"]] == [2, 1, 2]
    assert seen["stages"][0][:3] == [2, "C1C2", 30.0]
    assert "look around" in seen["stages"][1][3]
    assert seen["held"] == []
    trip = trips(tmp_path)["a"]
    assert trip.attrib["depart"] == "0.00"


LAST = {
    "a walk that goes on along its street": ("A1B1 B1C1 C1C2", 30.0, "", ("C1C2", 10.0)),
    "taken over on a crossing": ("A1B1 B1C1 C1C2", 30.0, ":B1_c2_0", ("C1C2", 10.0)),
    "taken over in a walkingarea": ("A1B1 B2B1", 20.0, ":B1_w3_0", ("B2B1", 70.0)),
    "against the street's direction": ("A1B1 B2B1", 20.0, "", ("B2B1", 70.0)),
    "on its only street": ("A1B1", 70.0, "", ("A1B1", 20.0)),
    "back where it was": ("B2B1 A1B1", 20.0, "", ("B2B1", 40.0)),
    "off its way": ("B2B1 A1B1", 20.0, "", ("C2C1", 40.0)),
}


@pytest.mark.parametrize("own_speed", ["", 'speed="0.9"'], ids=["any speed", "its own speed"])
@pytest.mark.parametrize(("edges", "arrival", "lane", "place"), LAST.values(), ids=LAST.keys())
def test_people_handed_back_keep_their_destination_and_speed(
    look: Look,
    edges: str,
    arrival: float,
    lane: str,
    place: tuple[str, float],
    own_speed: str,
) -> None:
    plan = f'<walk edges="{edges}" arrivalPos="{arrival}" {own_speed}/>'
    plan += f'<stop edge="{edges.split()[-1]}" duration="1"/>'
    seen = look("hand_back", "priority", person(plan), place=place, time=5.0, lane=lane)
    assert seen["handed_back"]
    assert seen["jump"] < 0.6
    last_street = {
        "C1C2": (204.0, 107.2 + arrival),  # northward, in metres from C1
        "B2B1": (96.0, 192.8 - arrival),  # southward
        "A1B1": (7.2 + arrival, 96.0),
    }[edges.split()[-1]]
    assert math.dist(seen["end"], last_street) < 2.0
    if own_speed:
        assert seen["fastest"] == pytest.approx(0.9, abs=0.02)
    else:
        assert seen["fastest"] > 1.0


def test_sumo_finds_no_way_and_the_person_stays_held(look: Look) -> None:
    nowhere = [
        (50.0, 50.0, "no such edge"),
        (math.nan, 50.0, "A1B1"),
        (50.0, math.inf, "A1B1"),
        (50.0, 98.9, "A1B1"),  # too far from the street's middle
    ]
    seen = look("refuse", "signals", person(EAST_AND_NORTH), places=nowhere)
    assert seen == {"answers": [False] * 4, "held": ["a"], "there": True}


def test_who_has_nothing_left_to_do_arrives_at_its_destination(look: Look, tmp_path: Path) -> None:
    seen = look("arrive", "signals", person(EAST_AND_NORTH), time=20.0, seconds=5.0)
    assert seen["arrived"]
    assert set(seen["stages"]) == {None}
    assert seen["counts"]["arrived"] == 1
    (walk,) = trips(tmp_path)["a"]  # and no stop "last stage removed"
    assert (walk.tag, walk.attrib["arrivalPos"]) == ("walk", "30.00")


def test_who_has_more_to_do_goes_on_and_can_be_taken_over_again(look: Look) -> None:
    seen = look("arrive", "signals", PLAN, time=20.0, seconds=10.0)
    assert not seen["arrived"]
    assert seen["stages"][0] == 1  # the stop begins with the next step
    assert seen["stages"][-1] == 2
    assert seen["again"]["edges"] == ["C1C2"]
    assert seen["counts"] == {
        "taken": 2, "handed_back": 0, "arrived": 0, "continued": 1, "lost": 0
    }  # fmt: skip


def test_cars_do_not_wait_at_a_crossing_a_held_person_has_left(look: Look) -> None:
    traffic = '<vType id="car" sigma="0"/>'
    for start, end in (("B0B1", "B1B2"), ("B2B1", "B1B0")):  # over the crossing, both ways
        traffic += f'<flow id="{start}" type="car" begin="0" end="200" period="20" '
        traffic += f'from="{start}" to="{end}" departLane="best"/>'
    crossing = person(EAST_AND_NORTH, 75.0)
    seen = look("cars_past", "priority", traffic + crossing, lane=":B1_c2_0", seconds=240.0)
    assert seen["cars"] == 20


def test_people_do_not_avoid_the_spot_of_a_person_taken_over(look: Look) -> None:
    flow = '<personFlow id="f" begin="12" end="60" period="9"><walk edges="A1B1"/></personFlow>'
    plans = person(EAST_AND_NORTH, 30.0) + flow
    without = look("followers", "signals", plans, taken=False)
    assert look("followers", "signals", plans, taken=True) == without


def test_to_ask_for_positions_changes_no_byte_of_sumos_output(look: Look, tmp_path: Path) -> None:
    plans = cars(100.0) + people(150)
    for asked in (False, True):
        seen = look("untouched", "signals", plans, asked=asked, seconds=100.0, fcd=f"{asked}.xml")
    assert seen["most"] > 100
    assert without_header(tmp_path / "True.xml") == without_header(tmp_path / "False.xml")


def test_taking_over_and_handing_back_leaves_far_cars_unchanged(look: Look) -> None:
    plans = cars(100.0) + people(150)
    held = look("vehicles", "bare", plans, holding=True, seconds=100.0)
    alone = look("vehicles", "bare", plans, holding=False, seconds=100.0)
    assert held["counts"]["handed_back"] > 100
    assert held["cars"] == alone["cars"]


@pytest.mark.parametrize(
    ("network", "step_length"), [("signals", 1.0), ("priority", 0.2), ("bare", 1.0)]
)
def test_a_roaming_zone_loses_nobody(
    look: Look, network: str, step_length: float, tmp_path: Path
) -> None:
    persons = 250
    plans = cars(150.0) + people(persons)
    seen = look("roam", network, plans, step_length, radius=70.0, seconds=150.0)
    counts = seen["counts"]
    assert counts["taken"] > 200
    ended = counts["handed_back"] + counts["arrived"] + counts["continued"]
    assert counts["taken"] == ended
    assert counts["lost"] == seen["held"] == seen["wrong"] == 0
    assert seen["off"] < 1e-6
    assert seen["jump"] <= 1.0
    assert Counter(seen["arrived"]) == Counter(f"p{i}" for i in range(persons))
    plan_of = {name: [stage.tag for stage in trip] for name, trip in trips(tmp_path).items()}
    for i in range(persons):
        tags = [t for k, t in enumerate(plan_of[f"p{i}"]) if plan_of[f"p{i}"][k - 1 : k] != [t]]
        assert tags == (["walk", "stop", "walk"] if i % 3 == 0 else ["walk"])


def test_a_trip_that_sumo_splits_into_stages_starts_at_its_start(look: Look) -> None:
    plan = '<walk edges="A1B1" arrivalPos="60"/><personTrip from="A1B1" to="C2C3" modes="public"/>'
    bus = """<busStop id="near" lane="B1C1_1" startPos="20" endPos="40"/>
        <busStop id="far" lane="C2C3_1" startPos="20" endPos="40"/>
        <flow id="bus" line="1" begin="0" end="600" period="60" from="B1C1" to="C2C3">
            <stop busStop="near" duration="10" until="30"/>
            <stop busStop="far" duration="10" until="60"/></flow>"""
    seen = look("arrive", "signals", bus + person(plan), time=5.0, seconds=5.0)
    assert seen["again"]["stages_left"] >= 1  # walks to the bus, and has more to do then


@pytest.mark.parametrize(("told", "walks"), [(9999.3, 1.4), (1.6, 1.6), (0.0, 0.0)])
def test_a_persons_jump_in_sumo_is_no_speed(told: float, walks: float) -> None:
    assert walked(told, 1.4) == walks
