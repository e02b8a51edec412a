"""People wait for a gap at crossings where vehicles have priority, as SUMO's own people do.

A street of 400 m along x with a crossing in its middle; judged from SUMO's own outputs.
"""

from __future__ import annotations

import subprocess
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
import sumo

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable

    Street = Callable[..., Path]
    Tracks = dict[str, np.ndarray]

PAIRS = ("wm", "mw", "me", "em")
CARS = """<flow id="f{to}" begin="0" end="160" probability="0.16" departSpeed="max">
    <route edges="{by} {to}"/></flow>"""
BOTH = CARS.format(by="wm", to="me") + CARS.format(by="em", to="mw")
PEOPLE = """<personFlow id="p" begin="0" end="120" period="4" departPos="180" type="{kind}">
    <walk edges="wm mw" arrivalPos="20"/></personFlow>
    <personFlow id="q" begin="0" end="120" period="4" departPos="20" type="{kind}">
    <walk edges="mw wm" arrivalPos="180"/></personFlow>"""
TYPES = """<vType id="plain" vClass="pedestrian"/><vType id="blind" vClass="pedestrian"
    jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="30"/>"""


@pytest.fixture(scope="module")
def networks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the networks in which people have priority, and in which they have not."""
    folder = tmp_path_factory.mktemp("networks")
    places = ("w", 0), ("m", 200), ("e", 400)
    nodes = "".join(f'<node id="{name}" x="{x}" y="0"/>' for name, x in places)
    edges = "".join(f'<edge id="{a}{b}" from="{a}" to="{b}" numLanes="1"/>' for a, b in PAIRS)
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "e.edg.xml").write_text(f"<edges>{edges}</edges>")
    for priority in ("true", "false"):
        crossing = f'<crossing node="m" edges="wm mw" priority="{priority}"/>'
        (folder / "c.con.xml").write_text(f"<connections>{crossing}</connections>")
        command = ["netconvert", "-n", "n.nod.xml", "-e", "e.edg.xml", "-x", "c.con.xml"]
        command += ["--sidewalks.guess", "--sidewalks.guess.max-speed", "20", "--no-turnarounds"]
        call(*command, "-o", f"{priority}.net.xml", folder=folder)
    return folder


def call(program: str, *words: object, folder: Path) -> None:
    """Run one of SUMO's programs."""
    command = [str(Path(sumo.SUMO_HOME) / "bin" / program), *map(str, words)]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


@pytest.fixture
def street(networks: Path, tmp_path: Path) -> Street:
    """Write a scenario of these routes; its path."""

    def write(routes: str, *, priority: str = "false") -> Path:
        (tmp_path / "a.rou.xml").write_text(f"<routes>{TYPES}{routes}</routes>")
        config = tmp_path / "a.sumocfg"
        config.write_text(
            f"""<configuration><net-file value="{networks}/{priority}.net.xml"/>
            <route-files value="a.rou.xml"/><end value="200"/><step-length value="0.2"/>
            </configuration>"""
        )
        return config

    return write


def tracks(file: Path, tag: str) -> Tracks:
    """Time [s] and place (n, 3) [m] of each person or vehicle at each step."""
    found = defaultdict(list)
    for step in ET.parse(file).getroot().iter("timestep"):
        for one in step.iter(tag):
            row = step.get("time"), one.get("x"), one.get("y")
            found[one.get("id")].append(tuple(map(float, row)))
    return {name: np.array(rows) for name, rows in found.items()}


def standing(people: Tracks) -> float:
    """The mean time [s] for which people move less than 0.2 m in a second."""
    moved = [np.hypot(*(t[5:, 1:] - t[:-5, 1:]).T) for t in people.values()]
    return 0.2 * float(np.mean([np.count_nonzero(way < 0.2) for way in moved]))


def walked(config: Path, *, seed: int = 1, model: str = "vci", **ego: object) -> Path:
    """Let giveway move the people of a scenario; SUMO's record of all places."""
    folder = config.parent / "run"
    giveway.run(
        {
            "scenario": str(config),
            "ego": ego or {"none": True},
            "crowd": {"zone": "80" if ego else "everywhere", "model": model},
            "sumo": {"outputs": ["fcd", "tripinfo"], "seed": seed, "baseline": False},
        },
        results=folder,
        force=True,
        pictures=False,
    )
    return folder / "sumo" / "fcd.xml"


def plain(config: Path, seed: int = 1) -> Path:
    """Let SUMO move them; its record."""
    words = "-c", config, "--seed", seed, "--fcd-output", "plain.xml", "--no-step-log"
    call("sumo", *words, folder=config.parent)
    return config.parent / "plain.xml"


@pytest.mark.parametrize("model", ["vci", "orca"])
def test_people_stand_about_as_long_as_those_of_sumo(street: Street, model: str) -> None:
    config = street(BOTH + PEOPLE.format(kind="plain"))
    alone, own = plain(config), walked(config, model=model)
    theirs, ours = standing(tracks(alone, "person")), standing(tracks(own, "person"))
    assert theirs > 5.0
    assert theirs / 1.5 < ours < 1.5 * theirs
    assert len(tracks(own, "vehicle")) == pytest.approx(len(tracks(alone, "vehicle")), rel=0.1)


def test_priority_and_types_decide_as_in_sumo(street: Street) -> None:
    cars, people = CARS.format(by="wm", to="me"), PEOPLE.replace('period="4"', 'period="12"')
    waits = standing(tracks(walked(street(cars + people.format(kind="plain"))), "person"))
    first = street(cars + people.format(kind="plain"), priority="true")
    assert standing(tracks(walked(first), "person")) < 1.0
    blind = street(cars + people.format(kind="blind"))
    assert 3.0 * standing(tracks(walked(blind), "person")) < waits


def test_waiting_people_wait_on_as_an_ego_comes(street: Street) -> None:
    """A stream of cars keeps people at the kerb until the ego, which ends it, takes them over."""
    stream = """<flow id="f" begin="0" end="50" period="1.6" departSpeed="max">
        <route edges="em mw"/></flow>"""
    ego = """<vehicle id="ego" depart="50" departSpeed="max"><route edges="em mw"/></vehicle>"""
    people = """<personFlow id="p" begin="20" end="50" period="4" departPos="190" type="plain">
        <walk edges="wm mw" arrivalPos="20"/></personFlow>"""
    fcd = walked(street(stream + people + ego), take_over=("ego",))
    ego, walkers = tracks(fcd, "vehicle")["ego"], tracks(fcd, "person")
    passes = ego[np.searchsorted(-ego[:, 1], -200.0), 0]
    there = np.array([track[np.searchsorted(track[:, 0], passes), 2] for track in walkers.values()])
    assert (np.abs(there) > 3.2).all()
    assert (there < 0.0).sum() >= 3  # they still wait
    assert passes - ego[0, 0] < 25.0  # the ego has not waited for them
    assert max(track[-1, 2] for track in walkers.values()) > 3.2  # and cross behind it
