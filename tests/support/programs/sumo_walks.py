"""Let SUMO's own people walk: ``python sumo_walks.py REQUEST.json OUT.json``.

The request names the sumo command and a number of steps. Out come, per walk, the edges, the
arrival and every place that SUMO's walker went through; and what each traffic light controls.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import libsumo

_WALKING = 2  # the stage type


def main() -> None:
    request = json.loads(Path(sys.argv[1]).read_text())
    libsumo.start(["sumo", *request["command"], "--no-step-log", "true", "--no-warnings", "true"])
    try:
        lights = libsumo.trafficlight
        links = {tls: lights.getControlledLinks(tls) for tls in lights.getIDList()}
        walks = _watch(request["steps"])
    finally:
        libsumo.close()
    Path(sys.argv[2]).write_text(json.dumps({"links": links, "walks": walks}))


def _watch(steps: int) -> list[dict[str, Any]]:
    person = libsumo.person
    walks: dict[tuple[str, int], dict[str, Any]] = {}
    for _ in range(steps):
        libsumo.simulationStep()
        for name in person.getIDList():
            stage = person.getStage(name)
            if stage.type != _WALKING:
                continue
            start = {"edges": list(stage.edges), "arrival": stage.arrivalPos, "places": []}
            walk = walks.setdefault((name, person.getRemainingStages(name)), start)
            walk["places"].append([*person.getPosition(name), person.getLaneID(name)])
        if not libsumo.simulation.getMinExpectedNumber():
            break
    return list(walks.values())


if __name__ == "__main__":
    main()
