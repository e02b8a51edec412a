"""People at a roundabout whose kerbs lie under the circulating lane; judged from SUMO's outputs."""

from __future__ import annotations

import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import sumo

import giveway

ARMS = "ensw"
RADIUS, FAR = 16.0, 90.0
CAR, TOUCHED = (5.0, 1.8), 0.22  # length and width [m]; a body's radius less 5 cm


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A roundabout of four arms, with cars straight on and people over each arm."""
    folder = tmp_path_factory.mktemp("roundabout")
    places = [complex(1.0, 0.0) * 1j**k for k in range(4)]
    nodes = [
        f'<node id="{a}" x="{FAR * p.real}" y="{FAR * p.imag}"/>'
        for a, p in zip(ARMS, places, strict=True)
    ]
    nodes += [
        f'<node id="r{k}" x="{RADIUS * p.real}" y="{RADIUS * p.imag}"/>'
        for k, p in enumerate(places)
    ]
    edges, flows = [], []
    for k, arm in enumerate(ARMS):
        bend = [RADIUS * places[k] * np.exp(1j * turn) for turn in (np.pi / 6, np.pi / 3)]
        shape = " ".join(f"{p.real:.2f},{p.imag:.2f}" for p in bend)
        opposite = ARMS[(k + 2) % 4]
        edges.append(f'<edge id="{arm}in" from="{arm}" to="r{k}" priority="2" speed="8.33"/>')
        edges.append(f'<edge id="{arm}out" from="r{k}" to="{arm}" priority="2" speed="8.33"/>')
        edges.append(
            f'<edge id="k{k}" from="r{k}" to="r{(k + 1) % 4}" priority="5" speed="6.9" '
            f'shape="{shape}" spreadType="center"/>'
        )
        flows.append(
            f'<flow id="f{arm}" begin="0" end="90" period="8" from="{arm}in" to="{opposite}out"/>'
            f'<personFlow id="p{arm}" begin="0" end="90" period="6">'
            f'<walk edges="{arm}out {arm}in"/></personFlow>'
            f'<personFlow id="q{arm}" begin="0" end="90" period="6">'
            f'<walk edges="{arm}in {arm}out"/></personFlow>'
        )
    (folder / "n.nod.xml").write_text(f"<nodes>{''.join(nodes)}</nodes>")
    (folder / "e.edg.xml").write_text(f"<edges>{''.join(edges)}</edges>")
    (folder / "a.rou.xml").write_text(f"<routes>{''.join(flows)}</routes>")
    (folder / "a.sumocfg").write_text(
        """<configuration><net-file value="a.net.xml"/><route-files value="a.rou.xml"/>
        <end value="70"/><step-length value="0.2"/></configuration>"""
    )
    words = ["-n", "n.nod.xml", "-e", "e.edg.xml", "--sidewalks.guess", "--crossings.guess"]
    words += ["--sidewalks.guess.exclude", "k0,k1,k2,k3", "--no-turnarounds", "-o", "a.net.xml"]
    call("netconvert", *words, folder=folder)
    return folder / "a.sumocfg"


def call(program: str, *words: object, folder: Path) -> None:
    """Run one of SUMO's programs."""
    command = [str(Path(sumo.SUMO_HOME) / "bin" / program), *map(str, words)]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def touched(fcd: Path) -> int:
    """The number of people whom cars touched at more than 1 m/s, and not as SUMO put them there."""
    found, before = set(), set()
    for step in ET.parse(fcd).getroot().iter("timestep"):
        people = {p.get("id"): (float(p.get("x")), float(p.get("y"))) for p in step.iter("person")}
        there = set(people)
        for car in step.iter("vehicle"):
            there.add(car.get("id"))
            x, y, angle, speed = (float(car.get(key)) for key in ("x", "y", "angle", "speed"))
            if speed <= 1.0 or not people or car.get("id") not in before:
                continue
            heading = np.radians(90.0 - angle)
            places = np.array(list(people.values())) - (x, y)
            along = places @ (np.cos(heading), np.sin(heading))
            aside = np.abs(places @ (-np.sin(heading), np.cos(heading)))
            behind = np.maximum(np.maximum(along, -CAR[0] - along), 0.0)
            near = np.hypot(behind, np.maximum(aside - CAR[1] / 2.0, 0.0)) < TOUCHED
            found |= {
                (car.get("id"), name)
                for name, hit in zip(people, near, strict=True)
                if hit and name in before
            }
        before = there
    return len(found)


def arrived(fcd: Path) -> int:
    """The number of cars that have left."""
    steps = [{car.get("id") for car in s.iter("vehicle")} for s in ET.parse(fcd).getroot()]
    return len(set.union(*steps) - steps[-1])


def test_cars_circulate_and_touch_nobody(scenario: Path) -> None:
    folder = scenario.parent
    call("sumo", "-c", scenario, "--fcd-output", folder / "alone.xml", "--seed", 3, folder=folder)
    result = giveway.run(
        {
            "scenario": str(scenario),
            "ego": {"none": True},
            "crowd": {"zone": "everywhere"},
            "sumo": {"outputs": ["fcd"], "seed": 3, "baseline": False},
        },
        results=folder / "run",
        pictures=False,
    )
    own = folder / "run" / "sumo" / "fcd.xml"
    assert touched(folder / "alone.xml") > 10
    assert touched(own) == 0
    assert "people_touched" not in result.manifest["traffic"]
    assert arrived(own) >= 0.9 * arrived(folder / "alone.xml")
    assert result.manifest["pedestrians"]["arrived"] > 15
