"""Prepare a scenario as giveway does and let it run by itself: ``python run_started.py JSON``.

A process of its own: libsumo holds one simulation per process.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

import libsumo

from giveway.geometry.bodies import VehicleShape
from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.sumo.types import all_types


def main(request: dict) -> None:
    options = request["options"]
    if options.get("outputs"):
        options["outputs"] = Path(options["outputs"])
    options["extra"] = tuple(options.get("extra", ()))
    scenario = read_scenario(Path(request["config"]))
    until = request["until"] or scenario.end
    with tempfile.TemporaryDirectory() as scratch:
        start = prepare_start(
            scenario,
            StartOptions(**options),
            Path(scratch),
            types=all_types({"giveway_ego": VehicleShape(4.0, 1.8)}),
        )
        libsumo.start(list(start.command))
        while libsumo.simulation.getTime() < until - 1e-9:
            libsumo.simulationStep()
        libsumo.close()
        answer = {
            "command": start.command,
            "remarks": start.remarks,
            "outputs": {str(old): str(new) for old, new in start.outputs.items()},
            "copies": {Path(new).name: str(old) for new, old in start.copies.items()},
            "seed": start.seed,
        }
    sys.stdout.write("\n" + json.dumps(answer) + "\n")


main(json.loads(sys.argv[1]))
