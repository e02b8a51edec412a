"""Networks that netgenerate makes, and SUMO's own people walking in them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import shapely
import sumo

from giveway.walkways import WalkNetwork, WalkRoute

if TYPE_CHECKING:
    from collections.abc import Callable

SUMO_HOME = Path(sumo.SUMO_HOME)
WALKS = Path(__file__).parents[2] / "support" / "programs" / "sumo_walks.py"
PAVED = ["--sidewalks.guess", "--crossings.guess", "--walkingareas"]
NETWORKS = {
    # 3 x 3 signalised junctions, 120 m apart, A0 in the south-west, C2 in the north-east
    "grid": ["--grid", "--grid.number", "3", "--grid.length", "120", "-j", "traffic_light", *PAVED],
    "spider": ["--spider", "--arms", "5", "--circles", "2", "--tls.guess", *PAVED],
    "random": ["--rand", "--rand.iterations", "25", "--seed", "4", "--tls.guess", *PAVED],
    # the same grid without anything for pedestrians: they walk on the road
    "bare": ["--grid", "--grid.number", "3", "--grid.length", "120"],
}


@dataclass(frozen=True)
class Built:
    """A network file, and what giveway reads in it."""

    file: Path
    network: WalkNetwork


def kerb_of(network: WalkNetwork, route: WalkRoute, wait: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the crossing begins before which a route waits, and the direction across the road."""
    shape = network._survey.crossings[network.signals[route.signals[wait]].crossing].shape
    if np.argmin(np.hypot(*(shape[[0, -1]] - route.waypoints[wait]).T)) == 1:
        shape = shape[::-1]
    way = shape[1] - shape[0]
    return shape[0], way / np.hypot(*way)


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Built]:
    """Build one of NETWORKS, once."""
    done: dict[str, Built] = {}

    def build(name: str) -> Built:
        if name not in done:
            file = tmp_path_factory.mktemp(name) / f"{name}.net.xml"
            command = [SUMO_HOME / "bin" / "netgenerate", *NETWORKS[name], "-o", file]
            subprocess.run(command, check=True, capture_output=True)
            done[name] = Built(file, WalkNetwork.read(file))
        return done[name]

    return build


@pytest.fixture(scope="session")
def walked() -> Callable[[WalkRoute, tuple[float, float]], shapely.LineString]:
    """The way of somebody alone: from line to line, each time to the nearest point of it."""

    def trace(route: WalkRoute, start: tuple[float, float]) -> shapely.LineString:
        places = [np.array(start)]
        for point, (d_x, d_y, half) in zip(route.waypoints, route.passages, strict=True):
            left, room = np.array([-d_y, d_x]), max(half - 0.27, 0.0)
            places.append(point + np.clip((places[-1] - point) @ left, -room, room) * left)
        return shapely.LineString(places)

    return trace


@pytest.fixture(scope="session")
def grid(built: Callable[[str], Built]) -> WalkNetwork:
    return built("grid").network


@pytest.fixture(scope="session")
def bare(built: Callable[[str], Built]) -> WalkNetwork:
    return built("bare").network


@pytest.fixture(scope="session")
def bundled_city() -> Path:
    """The pedestrian scenario that ships with SUMO: a real junction, its network gzipped."""
    return SUMO_HOME / "tools" / "game" / "fokr_bs_demo.sumocfg"


@pytest.fixture(scope="session")
def sumo_walks(
    built: Callable[[str], Built], tmp_path_factory: pytest.TempPathFactory, bundled_city: Path
) -> Callable[[str], dict[str, Any]]:
    """What SUMO's own people do in a network (sumo_walks.py), once for each."""
    done: dict[str, dict[str, Any]] = {}

    def walk(name: str) -> dict[str, Any]:
        if name not in done:
            folder = tmp_path_factory.mktemp(f"{name}_walks")
            if name == "bundled city":
                command = ["-c", bundled_city, "--gui-settings-file", "", "--step-length", "1"]
            else:
                command = ["-n", built(name).file, "-r", _trips(built(name).file, folder)]
            request = {"command": [str(part) for part in command], "steps": 500}
            (folder / "request.json").write_text(json.dumps(request))
            files = folder / "request.json", folder / "seen.json"
            subprocess.run([sys.executable, WALKS, *files], check=True, capture_output=True)
            done[name] = json.loads((folder / "seen.json").read_text())
        return done[name]

    return walk


def _trips(network: Path, folder: Path) -> Path:
    """120 walks in two minutes, each with up to 400 m between its ends."""
    trips = folder / "walks.rou.xml"
    command = [
        *(sys.executable, SUMO_HOME / "tools" / "randomTrips.py", "-n", network, "-o", trips),
        *("--pedestrians", "-e", "120", "-p", "1", "--seed", "3", "--max-distance", "400"),
    ]
    subprocess.run(command, check=True, capture_output=True, cwd=folder)
    return trips


EDGES = """<net>
    <location convBoundary="0.00,0.00,100.00,50.00"/>
    <edge id=":J" function="internal"><lane id=":J_0" length="1" shape="0,0 1,0"/></edge>
    <edge id="road" from="a" to="b">
        <lane id="road_0" index="0" disallow="pedestrian" length="50" width="3" shape="0,0 50,0"/>
        <lane id="road_1" index="1" allow="pedestrian bicycle" length="50" shape="0,3 50,3"/>
        <lane id="road_2" index="2" allow="pedestrian" length="60" width="2" shape="0,6,1 50,6,1"/>
    </edge>
    <edge id="motorway" from="a" to="b">
        <lane id="motorway_0" index="0" allow="passenger" length="50" shape="0,20 50,20"/>
    </edge>
    <edge id="lane" from="a" to="b">
        <lane id="lane_0" index="0" length="50" shape="0,30 50,30"/>
    </edge>
</net>"""


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str | bytes], Path]:
    def write(content: str | bytes) -> Path:
        file = tmp_path / "town.net.xml"
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        return file

    return write
