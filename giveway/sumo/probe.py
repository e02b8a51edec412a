"""SUMO tries a scenario: ``python -m giveway.sumo.probe CONFIG`` prints one line of JSON.

It is a process of its own, because SUMO may crash or hang, and holds one simulation per process.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.sumo.library import import_libsumo
from giveway.sumo.types import ROAD_CLASSES

_LOOK = 3.0  # [s] of wall clock: long enough to see vehicles depart, short enough to wait for
_ENOUGH = 3  # vehicles seen


def look(config_file: Path) -> dict[str, Any]:
    """Load the scenario as a run would and let it run for a moment."""
    sumo = import_libsumo()
    began = perf_counter()
    vehicles: dict[str, list[str]] = {}
    persons = 0
    with tempfile.TemporaryDirectory(prefix="giveway-") as scratch:
        start = prepare_start(read_scenario(config_file), StartOptions(), Path(scratch))
        sumo.start(list(start.command))
        loaded = perf_counter() - began
        end = sumo.simulation.getEndTime()
        began = perf_counter()
        while perf_counter() - began < _LOOK and len(vehicles) < _ENOUGH:
            if 0.0 <= end <= sumo.simulation.getTime():
                break
            if sumo.simulation.getMinExpectedNumber() == 0:
                break
            sumo.simulationStep()
            persons = max(persons, len(sumo.person.getIDList()))
            for name in sumo.simulation.getDepartedIDList():
                vehicle_class = sumo.vehicle.getVehicleClass(name)
                if vehicle_class in ROAD_CLASSES:
                    vehicles[name] = [vehicle_class, *sumo.vehicle.getRoute(name)]
        answer = {
            "loaded_in": loaded,
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


def main(config_file: Path) -> None:
    """Print what SUMO made of the scenario, or why it refused."""
    try:
        answer = look(config_file)
    except Exception as error:  # libsumo's, or ours; the rest of the reason is on stderr
        answer = {"refused": " ".join(str(error).split())}
    sys.stdout.write("\n" + json.dumps(answer) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
