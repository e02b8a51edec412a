"""Scenarios made by SUMO's own tools, and runs of them in processes of their own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import sumo

if TYPE_CHECKING:
    from collections.abc import Callable

SUMO_HOME = Path(sumo.SUMO_HOME)
RUN = Path(__file__).parent / "programs" / "run_started.py"


@pytest.fixture(scope="session")
def sumo_home() -> Path:
    """Where SUMO's programs, tools and demonstration scenarios lie."""
    return SUMO_HOME


@pytest.fixture(scope="session")
def call_sumo() -> Callable[..., str]:
    """Run one of SUMO's programs or tools; what it printed."""

    def call(*command: object, cwd: Path) -> str:
        environment = os.environ | {"SUMO_HOME": str(SUMO_HOME)}
        words = list(map(str, command))
        if words[0].endswith(".py"):
            words = [sys.executable, str(SUMO_HOME / "tools" / words[0]), *words[1:]]
        else:
            words[0] = str(SUMO_HOME / "bin" / words[0])
        result = subprocess.run(
            words, check=False, capture_output=True, text=True, cwd=cwd, env=environment, timeout=60
        )
        assert result.returncode == 0, result.stderr
        return result.stdout + result.stderr

    return call


@pytest.fixture(scope="session")
def small_city(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """A grid city with sidewalks, crossings, traffic lights, cars and persons: its .sumocfg."""
    folder = tmp_path_factory.mktemp("city")
    net = folder / "net.net.xml.gz"
    call_sumo(
        *("netgenerate", "--grid", "--grid.number", 4, "--grid.length", 120, "--seed", 1),
        *("--sidewalks.guess", "--crossings.guess", "--default-junction-type", "traffic_light"),
        *("-o", net),
        cwd=folder,
    )
    for name, options in (("cars", ("-p", 2)), ("walkers", ("-p", 1, "--persontrips"))):
        call_sumo(
            *("randomTrips.py", "-n", net, "-e", 60, "--seed", 5, *options),
            *("--prefix", name, "-o", folder / f"{name}.trips.xml"),
            cwd=folder,
        )
    (folder / "city.sumocfg").write_text(
        """<configuration>
        <input>
            <net-file value="net.net.xml.gz"/>
            <route-files value="cars.trips.xml, walkers.trips.xml"/>
        </input>
        <time><begin value="0:0:10"/><end value="80"/><step-length value="0.5"/></time>
        </configuration>"""
    )
    return folder / "city.sumocfg"


@pytest.fixture
def small_scenario(tmp_path: Path, small_city: Path) -> Callable[..., Path]:
    """Write a .sumocfg of the given lines, with the city's network and one car, in a new folder."""

    def write(*lines: str, folder: str = "scenario") -> Path:
        place = tmp_path / folder
        place.mkdir(parents=True, exist_ok=True)
        (place / "net.net.xml.gz").write_bytes((small_city.parent / "net.net.xml.gz").read_bytes())
        (place / "car.rou.xml").write_text(
            '<routes><trip id="car" depart="0" from="A0A1" to="C1C2"/></routes>'
        )
        config = place / "small.sumocfg"
        config.write_text(
            '<configuration><net-file value="net.net.xml.gz"/><route-files value="car.rou.xml"/>'
            + "".join(lines)
            + "</configuration>"
        )
        return config

    return write


@pytest.fixture
def run_started(tmp_path: Path, run_program: Callable[..., Any]) -> Callable[..., dict[str, Any]]:
    """Prepare and run a scenario in a process whose working folder is ``tmp_path / "cwd"``."""

    def run(config: Path, *, until: float | None = None, **options: Any) -> dict[str, Any]:
        cwd = tmp_path / "cwd"
        cwd.mkdir(exist_ok=True)
        request = {"config": str(config), "until": until, "options": options}
        result = run_program(RUN, json.dumps(request, default=str), cwd=cwd)
        assert result.returncode == 0, f"exit code {result.returncode}: {result.stderr}"
        seen: dict[str, Any] = json.loads(result.stdout.splitlines()[-1])
        return seen | {"stderr": result.stderr}

    return run
