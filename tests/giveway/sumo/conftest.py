"""Small cities that netgenerate makes, and looks at SUMO's people in them."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import sumo

if TYPE_CHECKING:
    from collections.abc import Callable

LOOKS = Path(__file__).parents[2] / "support" / "programs" / "sumo_persons.py"
GRID = ["--grid", "--grid.number", "4", "--grid.length", "100", "--no-turnarounds"]
PAVED = ["--sidewalks.guess", "--crossings.guess", "--walkingareas"]
CITIES = {
    # 4 x 4 junctions, 100 m apart, A0 in the south-west, D3 in the north-east
    "signals": [*GRID, *PAVED, "--default-junction-type", "traffic_light"],
    "priority": [*GRID, *PAVED, "--default-junction-type", "priority"],
    "islands": [*GRID, "--sidewalks.guess", "--walkingareas"],  # corners that no crossing joins
    "turnarounds": ["--grid", "--grid.number", "3", "--grid.length", "100", *PAVED[:2]],
    "bare": [*GRID, "--sidewalks.guess"],  # no crossings, no walkingareas
}


@pytest.fixture(scope="session")
def city(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The network file of one of CITIES, built once."""

    def build(name: str) -> Path:
        file = tmp_path_factory.getbasetemp() / f"{name}.net.xml"
        if not file.exists():
            netgenerate = Path(sumo.SUMO_HOME) / "bin" / "netgenerate"
            command = [netgenerate, *CITIES[name], "-o", file]
            subprocess.run(command, check=True, capture_output=True)
        return file

    return build


@pytest.fixture
def look(
    tmp_path: Path, city: Callable[[str], Path], run_program: Callable[..., Any]
) -> Callable[..., Any]:
    """Run one look of sumo_persons.py at ``plans`` in a city, in a process of its own.

    libsumo holds one simulation per process, and a crash of SUMO's must be a test that fails.
    """

    def run(name: str, network: str, plans: str, step_length: float = 0.5, **arguments: Any) -> Any:
        routes = tmp_path / "plans.add.xml"
        routes.write_text(f"<additional>{plans}</additional>")
        request = {
            "command": ["-n", str(city(network)), "-a", str(routes), "--seed", "1"]
            + ["--step-length", str(step_length), "--tripinfo-output", str(tmp_path / "trips.xml")]
        } | arguments
        result = run_program(LOOKS, name, json.dumps(request), cwd=tmp_path)
        assert result.returncode == 0, f"exit code {result.returncode}: {result.stderr}"
        return json.loads(result.stdout)

    return run
