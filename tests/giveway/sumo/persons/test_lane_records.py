"""Detectors, outputs and lights that look for persons find those that giveway moves.

A street along x with a crossing in its middle, whose light answers to requests.
"""

from __future__ import annotations

import os
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
import pytest
import sumo

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable

    Written = Callable[[str, str, float], Path]

PEOPLE = """<personFlow id="p" begin="0" end="160" period="{period}" departPos="{at}">
    <walk edges="wm mw" arrivalPos="30"/></personFlow>"""
CARS = '<flow id="f" begin="0" end="300" period="9"><route edges="wm me"/></flow>'
DETECTORS = """
    <inductionLoop id="loop" lane="wm_0" pos="70" period="900" file="loop.xml"
                   detectPersons="walk"/>
    <laneAreaDetector id="area" lane="wm_0" pos="60" endPos="80" period="900" file="area.xml"
                      detectPersons="walk"/>
    <edgeData id="sums" file="sums.xml" detectPersons="walk"/>"""


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("street")
    nodes = '<node id="w" x="0" y="0"/><node id="e" x="200" y="0"/>'
    nodes += '<node id="m" x="100" y="0" type="traffic_light"/>'
    pairs = ("wm", "mw", "me", "em")
    edges = "".join(f'<edge id="{a}{b}" from="{a}" to="{b}" numLanes="1"/>' for a, b in pairs)
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "e.edg.xml").write_text(f"<edges>{edges}</edges>")
    command = [Path(sumo.SUMO_HOME) / "bin" / "netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml"]
    command += ["--sidewalks.guess", "--sidewalks.guess.max-speed", "20", "--crossings.guess"]
    command += ["--tls.default-type", "actuated", "--no-turnarounds", "-o", "net.net.xml"]
    environment = os.environ | {"SUMO_HOME": sumo.SUMO_HOME}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    return folder / "net.net.xml"


@pytest.fixture
def written(street: Path, tmp_path: Path) -> Written:
    def write(routes: str, additional: str, step: float) -> Path:
        (tmp_path / "a.rou.xml").write_text(f"<routes>{routes}</routes>")
        (tmp_path / "a.add.xml").write_text(f"<additional>{additional}</additional>")
        config = tmp_path / "a.sumocfg"
        config.write_text(
            f"""<configuration><net-file value="{street}"/><route-files value="a.rou.xml"/>
            <additional-files value="a.add.xml"/><end value="300"/>
            <step-length value="{step}"/></configuration>"""
        )
        return config

    return write


def held_by_giveway(config: Path, folder: Path, zone: str = "everywhere") -> tuple[Any, Any]:
    """The result of a run and the rows of the people in it."""
    run = {"scenario": str(config), "ego": {"none": True}, "crowd": {"zone": zone}}
    run["sumo"] = {"outputs": ["tripinfo", "fcd"]}
    result = giveway.run(run, results=folder, pictures=False)
    rows = pd.read_csv(folder / "trajectories.csv", dtype={"id": str})
    return result, rows[rows["id"].str.startswith("p")]


def waits(trips: Path) -> list[float]:
    """The waiting times [s] of the persons who have arrived."""
    root = ET.parse(trips).getroot()
    return [float(person.get("waitingTime", "nan")) for person in root.iter("personinfo")]


@pytest.mark.parametrize("zone", ["everywhere", "60,-20 140,-20 140,20 60,20"])
def test_people_get_green_when_they_ask_for_it(
    written: Written, tmp_path: Path, call_sumo: Callable[..., str], zone: str
) -> None:
    config = written(PEOPLE.format(period=25, at=50) + CARS, "", 0.1)
    result, rows = held_by_giveway(config, tmp_path / "run", zone)
    call_sumo("sumo", "-c", config, "--tripinfo-output", tmp_path / "plain.xml", cwd=tmp_path)
    plain, found = waits(tmp_path / "plain.xml"), waits(tmp_path / "run" / "sumo" / "tripinfo.xml")
    assert result.manifest["pedestrians"]["taken_over"] >= 7
    assert len(found) == len(plain) == 7
    stands = (rows["speed"] < 0.1).sum() * result.manifest["time_step"]
    assert 3.0 < stands < sum(plain) + 7 * 5.0


def test_people_whom_sumo_does_not_know_get_green_in_the_end(
    written: Written, tmp_path: Path
) -> None:
    line = {"from": [[98.0, -4.5], [102.0, -4.5]], "to": [[98.0, 4.5], [102.0, 4.5]]}
    crowd = {"flow": [{"name": "ours", "rate": 720.0, "end": 60.0, **line}], "zone": "everywhere"}
    config = written(CARS, "", 0.5)
    run = {"scenario": str(config), "ego": {"none": True}, "crowd": crowd, "time_limit": 250.0}
    ledger = giveway.run(run).manifest["pedestrians"]
    assert ledger["added"] >= 3
    assert ledger["arrived"] == ledger["added"]


@pytest.mark.parametrize("time", ["", 'jmDriveAfterRedTime="1000"'])
def test_who_may_walk_at_red_does(written: Written, tmp_path: Path, time: str) -> None:
    kind = f'<vType id="bold" vClass="pedestrian" {time}/>'
    people = PEOPLE.format(period=25, at=50).replace("<personFlow", '<personFlow type="bold"')
    red = '<phase duration="1000" state="GGr"/>'
    light = f'<tlLogic id="m" type="static" programID="red" offset="0">{red}</tlLogic>'
    result, _ = held_by_giveway(written(kind + people, light, 0.5), tmp_path / "run")
    assert result.manifest["pedestrians"]["arrived"] == (7 if time else 0)


@pytest.mark.parametrize(
    ("zone", "step"),
    [
        ("everywhere", 0.1),
        ("everywhere", 0.5),
        ("70,-20 140,-20 140,20 70,20", 0.1),
        ("40,-20 60,-20 60,20 110,20 110,40 40,40", 0.1),
    ],
)
def test_counts_and_sums_are_those_of_the_trajectories(
    written: Written, tmp_path: Path, zone: str, step: float
) -> None:
    config = written(PEOPLE.format(period=8, at=50), DETECTORS, step)
    result, _ = held_by_giveway(config, tmp_path / "run", zone)
    sumo_outputs = tmp_path / "run" / "sumo"
    assert result.manifest["pedestrians"]["taken_over"] >= 20
    root = ET.parse(sumo_outputs / "fcd.xml").getroot()
    told_places = [
        (float(p.get("x", "nan")), float(p.get("y", "nan"))) for p in root.iter("person")
    ]
    rows = pd.DataFrame(told_places, columns=["x", "y"])
    for detector in ("loop", "area"):
        interval = next(ET.parse(sumo_outputs / f"{detector}.xml").getroot().iter("interval"))
        assert interval.get("nVehEntered") == "20", detector
    before = rows[rows["x"] < 98.0]  # the sidewalks' end at the crossing
    sides = {"wm": before[before["y"] < 0.0], "mw": before[before["y"] > 3.2]}
    edges = ET.parse(sumo_outputs / "sums.xml").getroot().iter("edge")
    told = {edge.get("id"): float(edge.get("sampledSeconds", "nan")) for edge in edges}
    for edge, found in sides.items():
        seconds = len(found) * step
        assert told[edge] == pytest.approx(seconds, rel=0.01, abs=20 * 2 * step), edge
    assert not (tmp_path / "run" / "sumo.log").exists()  # no warning about our own moves
