"""A trial of a scenario in SUMO, which prints a JSON line.

It runs in a process of its own, because SUMO may crash or hang, and a process holds one simulation.
"""

import itertools
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from time import perf_counter
from typing import Any

from fmus.archive.own_folder import OwnFolder
from giveway.errors import GivewayError
from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.sumo.encounters import Encounters
from giveway.sumo.library import import_libsumo
from giveway.sumo.network.lanes import Lanes
from giveway.sumo.scratch import PREFIX
from giveway.sumo.stderr import NativeStderr
from giveway.sumo.types import ROAD_CLASSES

_LOOK = 3.0  # Wall-clock time [s] of the trial: vehicles have departed by then in most scenarios
_ENOUGH = 3  # Number of vehicles after which the trial ends
_WATCH = 10.0  # Wall-clock time [s] in which encounters with people are counted
_LONGEST_WATCH = 600.0  # Longest time [s] in the scenario
_CAR = "passenger"
_TRIED = 30  # Number of edges between which a drive is searched
_LONGEST_DRIVE = 1000.0  # Longest drive [m] that is proposed


def look(config_file: Path, people: bool = False) -> dict[str, Any]:
    """Load the scenario as a run would, and let it run for a moment.

    Args:
        config_file: File .sumocfg of the scenario.
        people: True to let it run for longer, and count which vehicles meet pedestrians.
    """
    sumo = import_libsumo()
    began = perf_counter()
    vehicles: dict[str, list[str]] = {}
    persons = 0
    with OwnFolder(PREFIX) as folder:
        start = prepare_start(read_scenario(config_file), StartOptions(), Path(folder))
        sumo.start(list(start.command))
        loaded = perf_counter() - began
        end = sumo.simulation.getEndTime()
        began, begins = perf_counter(), sumo.simulation.getTime()
        encounters, enough = Encounters(sumo), False
        while perf_counter() - began < (_LOOK if not enough else _LOOK + _WATCH):
            if 0.0 <= end <= sumo.simulation.getTime():
                break
            if sumo.simulation.getMinExpectedNumber() == 0:
                break
            if enough and not (people and sumo.simulation.getTime() < begins + _LONGEST_WATCH):
                break
            sumo.simulationStep()
            persons = max(persons, len(sumo.person.getIDList()))
            for name in sumo.simulation.getDepartedIDList():
                vehicle_class = sumo.vehicle.getVehicleClass(name)
                encounters.departed(name, vehicle_class, sumo.vehicle.getRoute(name))
                if vehicle_class in ROAD_CLASSES and not enough:
                    vehicles[name] = [vehicle_class, *sumo.vehicle.getRoute(name)]
            enough = len(vehicles) >= _ENOUGH
            if people:
                encounters.look()
        route = [] if vehicles else _route(sumo)
        answer = {
            "loaded_in": loaded,
            "meetings": {"from": begins, **encounters.ranking},
            "way": _way(Lanes(sumo, config_file), [*vehicles.values()] or [[_CAR, *route]]),
            "route": route,
            "time": sumo.simulation.getTime(),
            "vehicles": vehicles,
            "persons": persons,
            "edges": len(sumo.edge.getIDList()),
            "outputs": [original.name for original in start.outputs],
            "remarks": start.remarks,
            "copies": {str(copy): str(original) for copy, original in start.copies.items()},
        }
        sumo.close()
    return answer


def _route(sumo: Any) -> list[str]:
    """Return the edges of the longest drive of at most 1 km between some of the network's edges."""
    edges = [
        edge
        for edge in sumo.edge.getIDList()
        if not edge.startswith(":") and _takes_cars(sumo, edge)
    ]
    tried = edges[:: max(1, len(edges) // _TRIED)]
    longest: tuple[float, list[str]] = (0.0, [])
    unheard = NativeStderr()  # a warning for each pair that is not connected
    with unheard:
        for start, goal in itertools.permutations(tried, 2):
            found = sumo.simulation.findRoute(start, goal)
            if found.edges and found.length <= _LONGEST_DRIVE:
                longest = max(longest, (found.length, list(found.edges)))
    unheard.close()
    return longest[1]


def _takes_cars(sumo: Any, edge: str) -> bool:
    lanes = [f"{edge}_{index}" for index in range(sumo.edge.getLaneNumber(edge))]
    allowed = [sumo.lane.getAllowed(lane) for lane in lanes]  # nothing stands for everything
    return any(not classes or _CAR in classes for classes in allowed)


def _way(lanes: Lanes, drives: Iterable[list[str]]) -> list[list[float]]:
    """Return the path x, y [m] of the first drive (kind of vehicle, edges) that has one."""
    for kind, *route in drives:
        try:
            points: list[list[float]] = lanes.along(route, None, kind=kind).points.tolist()
        except GivewayError:
            continue
        return points
    return []


def main(config_file: str, people: bool) -> None:
    """Print how SUMO read the scenario, or why it refused to."""
    try:
        answer = look(Path(config_file), people)
    except Exception as error:  # an error of libsumo or giveway; further reasons are on stderr
        answer = {"refused": " ".join(str(error).split())}
    sys.stdout.write("\n" + json.dumps(answer) + "\n")
