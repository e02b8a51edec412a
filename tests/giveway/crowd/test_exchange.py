"""The exchange of persons with SUMO: who is taken over, and who is handed back."""

from __future__ import annotations

import functools
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import libsumo
import numpy as np
import pytest

import giveway

if TYPE_CHECKING:
    from pathlib import Path


Drive = Callable[..., tuple[Any, Any]]  # the result of a run, and what was seen on the way


SQUARE = "60,60 240,60 240,240 60,240"


NO_EGO = {"none": True}


def adds_up(ledger: dict[str, int]) -> bool:
    came = ledger["added"] + ledger["taken_over"]
    return came == sum(ledger[k] for k in ("handed_back", "arrived", "continued", "walking"))


@pytest.fixture(scope="module")
def departed_alone(
    city: Callable[[float], Path],
    call_sumo: Callable[..., str],
    tmp_path_factory: pytest.TempPathFactory,
) -> Callable[[float], set[str]]:
    """Who sets out on foot up to a time [s] in a city that SUMO runs without us; run once each."""
    folder = tmp_path_factory.mktemp("alone")

    @functools.cache
    def people(until: float) -> set[str]:
        fcd = folder / "fcd.xml"
        plain = ("sumo", "-c", city(0.1), "--end", f"{until}", "--fcd-output", fcd)
        call_sumo(*plain, "--no-step-log", "--no-warnings", cwd=folder)
        return set(re.findall(r'<person id="([^"]+)"', fcd.read_text()))

    return people


@pytest.mark.parametrize(
    ("zone", "ego"),
    [("everywhere", "car10"), ("40", "car10"), (SQUARE, "car10"), (SQUARE, ""), ("none", "")],
)
def test_nobody_is_lost_frozen_or_there_twice(
    drive: Drive,
    city: Callable[[float], Path],
    departed_alone: Callable[[float], set[str]],
    zone: str,
    ego: str,
) -> None:
    config = {"ego": {"take_over": (ego,)} if ego else NO_EGO, "crowd": {"zone": zone}}
    result, look = drive(city(0.1), time_limit=60.0, controller="pid-paper", **config)
    ledger = result.manifest["pedestrians"]
    assert adds_up(ledger)
    assert (ledger["taken_over"] > 20) is (zone != "none")
    assert (ledger["handed_back"] > 0) is (zone in {"40", SQUARE})
    # Whom SUMO has is who has departed and not arrived, at every step; and it is who departs in
    # a SUMO left alone.
    assert max(look.departed.values()) == max(look.arrived.values(), default=1) == 1
    present = set(look.people[-1])
    assert present == set(look.departed) - set(look.arrived)
    assert departed_alone(look.times[-1]) == set(look.departed)
    assert look.ours[-1] == ledger["walking"] <= len(present)
    # Whom we have walked for 40 s has come somewhere.
    for name, (x, y) in look.people[-401].items():
        if name in present and name in set(result.crowd_track.ids):
            places = np.array([p[name] for p in look.people[-400:] if name in p])
            assert np.hypot(*(places - (x, y)).T).max() > 0.05, name


PLANS = """
    <vehicle id="car" depart="0"><route edges="A2B2 B2C2 C2D2"/></vehicle>
    <person id="walker" depart="0"><walk edges="A0B0 B0C0" departPos="5" arrivalPos="20"/></person>
    <person id="shopper" depart="0"><walk edges="A1B1" arrivalPos="12"/>
        <stop edge="A1B1" duration="15"/><walk edges="A1B1" arrivalPos="40"/></person>
    <person id="waiting" depart="0"><stop edge="A1B1" endPos="30" duration="60"/>
        <walk edges="A1B1" arrivalPos="70"/></person>
    <person id="rider" depart="triggered"><ride from="A2B2" to="C2D2" lines="car"/>
        <walk edges="C2D2" arrivalPos="70"/></person>
    <person id="late" depart="500"><walk edges="A0B0" arrivalPos="20"/></person>
"""


def test_who_waits_rides_or_has_not_departed_is_left_alone(scenario: Callable[..., Path]) -> None:
    config, ours, places = scenario(PLANS), {}, {}

    def look(progress: Any) -> None:
        now = round(libsumo.simulation.getTime(), 3)
        for name in libsumo.person.getIDList():
            stage = libsumo.person.getStage(name).type
            places.setdefault(name, {})[now] = (stage, libsumo.person.getPosition(name))

    result = giveway.run(
        {"scenario": str(config), "ego": NO_EGO, "crowd": {"zone": "everywhere"}}, watcher=look
    )
    for k, i in zip(result.crowd_track.step, result.crowd_track.pedestrian, strict=True):
        ours.setdefault(result.crowd_track.ids[i], set()).add(round(float(result.time[k]), 2))
    assert set(ours) == {"walker", "shopper", "waiting", "rider"}
    for name, times in ours.items():
        walking = {round(t, 2) for t, (stage, _) in places[name].items() if stage == 2}
        other = {round(t, 2) for t, (stage, _) in places[name].items() if stage != 2}
        assert not times & other
        assert walking
    assert min(ours["waiting"]) >= 60.0
    assert min(ours["rider"]) > 20.0
    # The shopper walks, stops for 15 s by itself, and walks again.
    pause = sorted(ours["shopper"])
    assert max(np.diff(pause)) == pytest.approx(15.0, abs=1.0)
    ledger = result.manifest["pedestrians"]
    assert adds_up(ledger)
    assert (ledger["taken_over"], ledger["arrived"], ledger["continued"]) == (5, 4, 1)


def test_who_is_handed_back_arrives_in_the_end(drive: Drive, scenario: Callable[..., Path]) -> None:
    people = "".join(
        f'<person id="p{i}" depart="{i}"><walk from="A1B1" to="{goal}"/></person>'
        for i, goal in enumerate(["C1D1", "B1B2", "C1C0", "B2C2", "B1A1", "B0B1"] * 3)
    )
    zone = "140,140 60,140 60,60 140,60"  # round B1
    config = scenario(people, end=1500, step=1)
    result, look = drive(config, ego=NO_EGO, crowd={"zone": zone}, record={"far_period": 10.0})
    ledger = result.manifest["pedestrians"]
    assert adds_up(ledger)
    assert ledger["handed_back"] >= 6
    assert look.arrived == {f"p{i}": 1 for i in range(18)}


def test_nobody_jumps_in_sumo_when_handed_back(
    scenario: Callable[..., Path], tmp_path: Path
) -> None:
    """Strips of 12 m, 40 m apart; half of the walks turn round onto the street's other side."""
    walks = [("A1B1", "B1A1"), ("B1B2", "B2B1"), ("A1B1", "C1D1"), ("B2C2", "C1C0")] * 8
    people = "".join(
        f'<person id="p{i}" depart="{i}"><walk from="{a}" to="{b}" departPos="{5 + 10 * (i % 8)}"/>'
        "</person>"
        for i, (a, b) in enumerate(walks)
    )
    strips = "".join(f"{x},-9 {x},310 {x + 12},310 {x + 12},-9 " for x in range(5, 300, 40))
    zone = f"-40,-10 -40,-9 {strips}340,-9 340,-10"
    config = {"scenario": str(scenario(people, end=250, step=0.5)), "crowd": {"zone": zone}}
    config |= {"ego": NO_EGO, "sumo": {"outputs": ["fcd"]}}
    folder = tmp_path / "run"
    ledger = giveway.run(config, results=folder, pictures=False).manifest["pedestrians"]
    assert ledger["handed_back"] > 60
    assert adds_up(ledger)
    last: dict[str, tuple[float, ...]] = {}
    for _, element in ET.iterparse(folder / "sumo" / "fcd.xml"):
        if element.tag == "person":
            name, place = element.attrib["id"], tuple(float(element.attrib[k]) for k in "xy")
            assert math.dist(place, last.get(name, place)) < 1.0 + 0.5 * 2.0, name
            last[name] = place


def test_people_of_a_saved_state_are_taken_over_and_arrive(
    scenario: Callable[..., Path], call_sumo: Callable[..., str]
) -> None:
    people = "".join(
        f'<person id="p{i}" depart="{i * 10}"><walk from="A1B1" to="B1C1"/></person>'
        for i in range(6)
    )
    config = scenario(people, '<load-state value="state.xml"/>', end=400, step=0.5)
    loading = config.read_text()
    config.write_text(loading.replace('<load-state value="state.xml"/>', ""))
    saving = ("--save-state.times", "40", "--save-state.files", "state.xml", "--end", "41")
    call_sumo("sumo", "-c", config, *saving, "--save-state.transportables", cwd=config.parent)
    config.write_text(loading.replace('<begin value="0"/>', '<begin value="40"/>'))
    result = giveway.run({"scenario": str(config), "ego": NO_EGO, "crowd": {"zone": "everywhere"}})
    ledger = result.manifest["pedestrians"]
    assert (ledger["taken_over"], ledger["arrived"]) == (6, 6)
