"""The files of a scenario on a map of OpenStreetMap: its network, cars and people at random."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final, NamedTuple
from xml.etree import ElementTree

import tomlkit

from giveway.errors import ScenarioError
from giveway.scenario_files.configuration_text import configuration_of
from sumo_scenarios.build import netconvert_and_home

_BUILD: Final = """<?xml version="1.0" encoding="UTF-8"?>
<!-- Map data © OpenStreetMap contributors, Open Database Licence (ODbL) -->
<configuration>
    <input>
        <node-files value="{name}.nod.xml"/>
        <edge-files value="{name}.edg.xml"/>
        <connection-files value="{name}.con.xml"/>
        <tllogic-files value="{name}.tll.xml"/>
        <type-files value="{name}.typ.xml"/>
    </input>
    <output>
        <output-file value="{name}.net.xml"/>
    </output>
    <junctions>
        <walkingareas value="true"/>
    </junctions>
</configuration>
"""
_HEADER: Final = re.compile(r"<!-- generated on .*?-->\s*", re.DOTALL)
_FARTHEST: Final = 300.0  # Longest trip [m] of people, as the crow flies
_EGO_FROM: Final = 60.0  # Earliest departure [s] of the vehicle that becomes the ego
_LATE: Final = 300.0  # Time [s] that the scenario goes on after the last departure


class Demand(NamedTuple):
    """The traffic of a whole map.

    Attributes:
        vehicles: Vehicles in an hour.
        people: Persons in an hour.
        duration: Time [s] in which they depart.
        seed: Seed of their trips.
    """

    vehicles: float = 360.0
    people: float = 2400.0
    duration: float = 600.0
    seed: int = 1


def map_configuration(name: str, demand: Demand) -> dict[str, str]:
    """Return the configurations of netconvert and of SUMO, by the names of their files."""
    end, routes = demand.duration + _LATE, [*_kinds(name, demand)]
    return {
        f"{name}.netccfg": _BUILD.format(name=name),
        f"{name}.sumocfg": configuration_of(name, end, step=0.1, routes=routes),
    }


def _kinds(name: str, demand: Demand) -> dict[str, tuple[str, float]]:
    """Return kind and number in an hour of the traffic in each file of routes."""
    kinds = {"cars": demand.vehicles, "people": demand.people}
    return {f"{name}.{kind}.rou.xml": (kind, hourly) for kind, hourly in kinds.items() if hourly}


def map_traffic(network: Path, name: str, demand: Demand) -> dict[str, str]:
    """Return the routes on a network and the settings of a run, by the names of their files.

    Args:
        network: Network that has been built.
        name: Name of the scenario.
        demand: Traffic.

    Raises:
        ScenarioError: SUMO's tools are missing, or find no trips on the network.
    """
    files = {
        file: _trips(network, kind, hourly, demand)
        for file, (kind, hourly) in _kinds(name, demand).items()
    }
    document = tomlkit.document()
    document["description"] = f"Streets of {name}, map data © OpenStreetMap contributors (ODbL)"
    cars = files.get(f"{name}.cars.rou.xml")
    if cars and (ego := _ego(network, cars)):
        document["ego"] = {"take_over": [ego]}
    return files | {f"{name}.giveway.toml": tomlkit.dumps(document)}


def _trips(network: Path, kind: str, hourly: float, demand: Demand) -> str:
    """Return the routes of vehicles or people, drawn by SUMO's randomTrips.py.

    Raises:
        ScenarioError: it is missing, or fails.
    """
    _, home = netconvert_and_home()
    tool = home / "tools" / "randomTrips.py"
    if not tool.is_file():
        raise ScenarioError(f"{tool} is missing; pip install 'giveway[new]'")
    drawn = {"cars": ["--fringe-factor", "5", "--trip-attributes", _BEST]}
    drawn["people"] = ["--pedestrians", "--prefix", "p", "--max-distance", f"{_FARTHEST:g}"]
    with tempfile.TemporaryDirectory() as scratch:
        routes = Path(scratch) / "routes.xml"
        options = {
            "-n": network.resolve(),
            "-r": routes,
            "-o": Path(scratch) / "trips.xml",
            "--seed": demand.seed,
            "--end": f"{demand.duration:g}",
            "--period": f"{3600.0 / hourly:.6g}",
        }
        words = [str(word) for pair in options.items() for word in pair]
        done = subprocess.run(
            [sys.executable, str(tool), *words, *drawn[kind], "--validate"],
            capture_output=True,
            text=True,
            check=False,
            cwd=scratch,
            env=os.environ | {"SUMO_HOME": str(home)},
        )
        if done.returncode or not routes.is_file():
            reason = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise ScenarioError(f"randomTrips.py finds no trips of {kind} ({reason}); {_SMALL}")
        return _HEADER.sub("", routes.read_text(encoding="utf-8"))


_BEST: Final = 'departLane="best" departSpeed="max"'
_SMALL: Final = "choose a larger map, with streets that are connected"


def _ego(network: Path, cars: str) -> str:
    """Return the id of the vehicle whose route has most crossings; empty without any vehicle."""
    crossed = {
        frozenset(edge.get("crossingEdges", "").split())
        for edge in ElementTree.parse(network).iter("edge")
        if edge.get("function") == "crossing"
    }
    most, chosen = -1, ""
    for vehicle in ElementTree.fromstring(cars).iter("vehicle"):
        route = vehicle.find("route")
        if route is None or float(vehicle.get("depart", "0")) < _EGO_FROM:
            continue
        edges = set(route.get("edges", "").split())
        count = sum(bool(edges & crossing) for crossing in crossed)
        if count > most:
            most, chosen = count, vehicle.get("id", "")
    return chosen
