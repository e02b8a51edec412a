"""Each stage that SUMO's persons know: no run dies of it, and nobody is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

# A street with sidewalks, and a railway beside it whose platforms are reached by `access`.
NODES = """<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0"/><node id="c" x="400" y="0"/>
    <node id="p" x="0" y="40"/><node id="q" x="400" y="40"/></nodes>"""
EDGES = """<edges><edge id="ab" from="a" to="b" speed="13.89" sidewalkWidth="2"/>
    <edge id="bc" from="b" to="c" speed="13.89" sidewalkWidth="2"/>
    <edge id="rail" from="p" to="q" speed="20" allow="rail tram"/></edges>"""
STOPS = """<additional>
    <trainStop id="west" lane="rail_0" startPos="60" endPos="100"><access lane="ab_0" pos="80"/>
    </trainStop>
    <trainStop id="east" lane="rail_0" startPos="300" endPos="340"><access lane="bc_0" pos="120"/>
    </trainStop>
    <busStop id="kerb" lane="ab_1" startPos="120" endPos="140"/>
    <busStop id="far" lane="bc_1" startPos="40" endPos="60"/>
    <vType id="tram" vClass="tram" length="20"/></additional>"""
VEHICLES = """
    <vehicle id="T" type="tram" depart="0" line="T"><route edges="rail"/>
        <stop busStop="west" duration="115"/><stop busStop="east" duration="5"/></vehicle>
    <vehicle id="bus" depart="1" line="bus"><route edges="ab bc"/>
        <stop busStop="kerb" duration="115"/><stop busStop="far" duration="5"/></vehicle>
    <trip id="own" depart="triggered" departPos="40" from="ab" to="bc">
        <stop lane="bc_1" endPos="100" duration="3"/></trip>"""
EGO = '<vehicle id="ego" depart="10"><route edges="ab bc"/></vehicle>'

# The plan of each person, how often giveway takes them over, and whether they arrive in time
PLANS = {
    "waiting": (
        '<stop lane="ab_0" endPos="60" duration="20"/><walk edges="ab" arrivalPos="150"/>',
        1,
        True,
    ),
    "until": (
        '<walk edges="ab" arrivalPos="60"/><stop lane="ab_0" endPos="60" until="30"/>'
        '<walk edges="ab bc" arrivalPos="30"/>',
        2,
        True,
    ),
    "access": (
        '<walk from="ab" busStop="west"/><ride busStop="east" lines="T"/>'
        '<walk to="bc" arrivalPos="180"/>',
        2,
        True,
    ),
    "ride": (
        '<walk edges="ab" busStop="kerb"/><ride from="ab" busStop="far" lines="bus"/>'
        '<walk edges="bc" arrivalPos="150"/>',
        2,
        True,
    ),
    "missed": ('<walk edges="ab" busStop="kerb"/><ride busStop="far" lines="none"/>', 1, False),
    "driven": (
        '<ride from="ab" to="bc" lines="own"/><walk edges="bc" arrivalPos="180"/>',
        1,
        True,
    ),
    "trip": ('<personTrip from="ab" to="bc" arrivalPos="100" modes="public"/>', 1, True),
    "tranship": (
        '<walk edges="ab" arrivalPos="80"/><tranship from="ab" to="bc" speed="2"/>',
        1,
        False,
    ),
}


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    folder = tmp_path_factory.mktemp("station")
    (folder / "n.nod.xml").write_text(NODES)
    (folder / "e.edg.xml").write_text(EDGES)
    files = ("-n", "n.nod.xml", "-e", "e.edg.xml", "-o", "s.net.xml")
    call_sumo("netconvert", *files, cwd=folder)
    (folder / "stops.add.xml").write_text(STOPS)
    people = "".join(
        f'<person id="{name}" depart="{2 + i}" departPos="30">{plan}</person>'
        for i, (name, (plan, _, _)) in enumerate(PLANS.items())
    )
    (folder / "r.rou.xml").write_text(f"<routes>{VEHICLES}{people}{EGO}</routes>")
    (folder / "s.sumocfg").write_text(
        '<configuration><net-file value="s.net.xml"/><additional-files value="stops.add.xml"/>'
        '<route-files value="r.rou.xml"/><end value="240"/><step-length value="0.5"/>'
        "</configuration>"
    )
    return folder / "s.sumocfg"


def drive(station: Path, zone: str, **ego: Any) -> dict[str, int]:
    settings = {"scenario": str(station), "crowd": {"zone": zone}, "ego": ego}
    people: dict[str, int] = giveway.run(settings).manifest["pedestrians"]
    return people


def test_people_of_all_stages_are_taken_over_for_each_walk(station: Path) -> None:
    people = drive(station, "everywhere", none=True)
    assert people["taken_over"] == sum(walks for _, walks, _ in PLANS.values())
    assert people["arrived"] == sum(arrives for _, _, arrives in PLANS.values())
    assert people["walking"] == people["handed_back"] == 0
    assert people["continued"] == people["taken_over"] - people["arrived"]


def test_an_ego_passes_people_of_all_stages(station: Path) -> None:
    people = drive(station, "80", take_over=["ego"])
    assert people["taken_over"] > 0
    gone = sum(people[key] for key in ("handed_back", "arrived", "continued", "walking"))
    assert gone == people["taken_over"]
