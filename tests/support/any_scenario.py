"""Scenarios that giveway has never seen, made by SUMO's own tools, and what is seen in them.

The city is a grid of 4 x 4 signalised junctions, 100 m apart, A0 in the south-west. Each street has
two lanes for cars and a sidewalk of 2 m per direction; edge A0B0 runs east, its sidewalk is south.

    A3--B3--C3--D3      300 cars and 1,200 walkers, beginning at 90 s, gz-compressed, with an
    |   |   |   |       additional file and outputs of its own.
    A0--B0--C0--D0
"""

from __future__ import annotations

import gzip
import math
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import libsumo
import numpy as np
import pytest
import shapely
import sumo

import giveway
from giveway.walkways import WalkNetwork

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from giveway import RunResult
    from giveway.run_data.progress import Progress

HOME = Path(sumo.SUMO_HOME)
BEGIN, END = 90, 400  # [s] of the city


@pytest.fixture(scope="session")
def demonstration() -> Path:
    """The pedestrian scenario that ships with SUMO: a junction in Braunschweig, from 15:00:00."""
    return HOME / "tools" / "game" / "fokr_bs_demo.sumocfg"


# --- scenarios -----------------------------------------------------------------------------------


@pytest.fixture(scope="session")
def town(tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]) -> Path:
    """The folder of the city's files."""
    folder = tmp_path_factory.mktemp("city")
    net = folder / "net.net.xml.gz"
    call_sumo(
        *("netgenerate", "--grid", "--grid.number", 4, "--grid.length", 100, "-o", net),
        *("--sidewalks.guess", "--crossings.guess", "--default-junction-type", "traffic_light"),
        *("--default.lanenumber", 2),
        cwd=folder,
    )
    for name, options in (("walkers", ("-p", 0.25, "--pedestrians")), ("cars", ("-p", 2))):
        trips = folder / f"{name}.trips.xml"
        times = ("-b", BEGIN if name == "cars" else 100, "-e", END)
        prefix = ("--prefix", "ped" if name == "walkers" else "car")
        call_sumo(
            *("randomTrips.py", "-n", net, *times, "--seed", 6, *options, *prefix, "-o", trips),
            cwd=folder,
        )
        (folder / f"{trips.name}.gz").write_bytes(gzip.compress(trips.read_bytes()))
        trips.unlink()
    (folder / "routes.rou.xml").unlink(missing_ok=True)  # a by-product of randomTrips
    (folder / "outputs.add.xml").write_text(
        '<additional><edgeData id="e" file="edges.xml" period="10"/></additional>'
    )
    for step in (1, 0.1, 0.05):
        (folder / f"city_{step}.sumocfg").write_text(
            f"""<configuration>
            <input>
                <net-file value="{net.name}"/>
                <route-files value="walkers.trips.xml.gz, cars.trips.xml.gz"/>
                <additional-files value="outputs.add.xml"/>
            </input>
            <output><tripinfo-output value="trips.out.xml"/></output>
            <time><begin value="{BEGIN}"/><end value="{END}"/><step-length value="{step}"/></time>
            <processing><time-to-teleport value="120"/></processing>
            </configuration>"""
        )
    return folder


@pytest.fixture(scope="session")
def city(town: Path) -> Callable[[float], Path]:
    """The city's .sumocfg with a step length [s]."""
    return lambda step: town / f"city_{step}.sumocfg"


@pytest.fixture(scope="session")
def network(town: Path) -> WalkNetwork:
    """Where people walk in the city."""
    return WalkNetwork.read(town / "net.net.xml.gz")


@pytest.fixture
def scenario(tmp_path: Path, town: Path) -> Callable[..., Path]:
    """Write a scenario on the city's network: routes, options, begin, end and step length."""

    def write(
        routes: str,
        options: str = "",
        *,
        net: Path | None = None,
        end: float = 200,
        step: float = 0.1,
    ) -> Path:
        place = tmp_path / f"scenario{len(list(tmp_path.iterdir()))}"
        place.mkdir()
        (place / "all.rou.xml").write_text(f"<routes>{routes}</routes>")
        config = place / "small.sumocfg"
        config.write_text(
            f"""<configuration>
            <net-file value="{net or town / "net.net.xml.gz"}"/><route-files value="all.rou.xml"/>
            <begin value="0"/><end value="{end}"/><step-length value="{step}"/>{options}
            </configuration>"""
        )
        return config

    return write


# --- runs ----------------------------------------------------------------------------------------


class Look:
    """What SUMO itself has at each of its steps, noted while giveway runs."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.people: list[dict[str, tuple[float, float]]] = []
        self.cars: list[dict[str, tuple[float, ...]]] = []  # x, y, angle, speed, length, width
        self.states: list[dict[str, str]] = []
        self.ours: list[int] = []
        self.departed: Counter[str] = Counter()
        self.arrived: Counter[str] = Counter()
        self.lanes: dict[str, np.ndarray] = {}
        self.widths: dict[str, float] = {}
        self.crossings: dict[str, tuple[str, int]] = {}
        self.links: dict[tuple[str, str], tuple[str, int]] = {}  # from lane to lane

    def __call__(self, progress: Progress) -> None:
        if progress.doing:  # SUMO does not run in this process then
            return
        now = libsumo.simulation.getTime()
        if abs(now - progress.clock) > 1e-6 or (self.times and now <= self.times[-1]):
            return
        if not self.times:
            self._map()
        person, vehicle, lights = libsumo.person, libsumo.vehicle, libsumo.trafficlight
        self.times.append(now)
        self.ours.append(progress.pedestrians)
        self.people.append({n: person.getPosition(n) for n in person.getIDList()})
        self.cars.append({n: _body(vehicle, n) for n in vehicle.getIDList()})
        self.states.append({n: lights.getRedYellowGreenState(n) for n in lights.getIDList()})
        self.departed.update(libsumo.simulation.getDepartedPersonIDList())
        self.arrived.update(libsumo.simulation.getArrivedPersonIDList())

    def _map(self) -> None:
        for lane in libsumo.lane.getIDList():
            self.lanes[lane] = np.array(libsumo.lane.getShape(lane))
            self.widths[lane] = libsumo.lane.getWidth(lane)
        for system in libsumo.trafficlight.getIDList():
            for link, movements in enumerate(libsumo.trafficlight.getControlledLinks(system)):
                for source, target, _ in movements:
                    self.links[source, target] = system, link
                    if "_c" in target and target.startswith(":"):
                        self.crossings[target] = system, link

    def colour(self, source: str, target: str, time: float) -> str:
        """The light's letter for going from lane to lane, as set before ``time`` [s]."""
        system, link = self.links[source, target]
        return self.states[int(np.searchsorted(self.times, time + 1e-6)) - 1][system][link]

    def entered(self, names: set[str]) -> tuple[int, int]:
        """How often one of ``names`` set out over a crossing at green, and at red.

        On it is who is 2 m away from both its ends and no farther than half its width from its
        middle; at red is who sets out when it has been red for 3 s.
        """
        rows = [(k, n) for k, people in enumerate(self.people) for n in people if n in names]
        steps = np.array([k for k, _ in rows])
        places = np.array([self.people[k][n] for k, n in rows])
        counts = [0, 0]
        for crossing, (system, link) in self.crossings.items():
            line, half = shapely.LineString(self.lanes[crossing]), self.widths[crossing] / 2
            x_0, y_0, x_1, y_1 = line.buffer(half).bounds
            near = (places > (x_0, y_0)).all(axis=1) & (places < (x_1, y_1)).all(axis=1)
            points = shapely.points(places[near])
            along = shapely.line_locate_point(line, points)
            inside = (along > 2.0) & (along < line.length - 2.0)
            inside &= shapely.distance(line, points) < half
            on = {rows[i] for i in np.flatnonzero(near)[inside]}
            red_for = np.zeros(len(self.times))
            for k in range(1, len(self.times)):
                lasts = self.times[k] - self.times[k - 1]
                red = self.states[k][system][link] not in "gG"
                red_for[k] = red_for[k - 1] + lasts if red else 0.0
            for k, name in on:
                if k > steps[0] and (k - 1, name) not in on:
                    counts[int(red_for[k] > 3.0)] += 1
        return counts[0], counts[1]

    def touched(self, names: set[str] | None = None, *, faster_than: float = 0.5) -> set[Any]:
        """(car, person) of all persons (or ``names``) whom a driving car's rectangle covers."""
        pairs = set()
        for people, cars in zip(self.people, self.cars, strict=True):
            ids = [n for n in people if names is None or n in names]
            if not ids:
                continue
            tree = shapely.STRtree(shapely.points(np.array([people[n] for n in ids])))
            for car, body in cars.items():
                if body[3] > faster_than:
                    pairs |= {(car, ids[i]) for i in tree.query(rectangle(body), "contains")}
        return pairs

    def collided(self, ego: str) -> set[str]:
        """The vehicles whose rectangle the ego's has met."""
        met = set()
        for cars in self.cars:
            if ego in cars:
                mine, (x, y, *_) = rectangle(cars[ego]), cars[ego]
                met |= {
                    name
                    for name, body in cars.items()
                    if name != ego
                    and math.dist(body[:2], (x, y)) < 30.0
                    and rectangle(body).intersection(mine).area > 0.01
                }
        return met


def _body(vehicle: Any, name: str) -> tuple[float, ...]:
    size = vehicle.getLength(name), vehicle.getWidth(name)
    return (*vehicle.getPosition(name), vehicle.getAngle(name), vehicle.getSpeed(name), *size)


def rectangle(body: tuple[float, ...]) -> shapely.Polygon:
    """The outline of a vehicle, whose place is its front's middle."""
    x, y, angle, _, length, width = body
    heading = math.radians(90.0 - angle)
    c, s = math.cos(heading), math.sin(heading)
    corners = [(0.0, 0.5), (0.0, -0.5), (-length, -0.5), (-length, 0.5)]
    return shapely.Polygon(
        [(x + a * c - b * width * s, y + a * s + b * width * c) for a, b in corners]
    )


@pytest.fixture(scope="session")
def drive() -> Callable[..., tuple[RunResult, Look]]:
    """Run a configuration through the real SUMO, FMU and solver, and look on; equal ones once."""
    done: dict[str, tuple[RunResult, Look]] = {}

    def run(scenario: Path, **config: Any) -> tuple[RunResult, Look]:
        key = repr((scenario, sorted(config.items())))
        if key not in done:
            look = Look()
            config["sumo"] = {"baseline": False, **config.get("sumo", {})}
            result = giveway.run({"scenario": str(scenario), **config}, watcher=look)
            done[key] = result, look
        return done[key]

    return run


@pytest.fixture(scope="session")
def crowded(
    drive: Callable[..., tuple[RunResult, Look]], city: Callable[[float], Path]
) -> tuple[RunResult, Look]:
    """A minute of the city in which everybody on foot is ours, and one of its cars."""
    return drive(
        city(0.1),
        ego={"take_over": ("car10",)},
        crowd={"zone": "everywhere", "preset": "SIM"},
        regulation={"reference_speed": 4.0},  # there for the whole minute
        time_limit=60.0,
    )


@pytest.fixture
def unchanged() -> Iterator[Callable[[Path], None]]:
    """Say of folders before a run that they will be the same after it."""
    before: dict[Path, dict[Path, bytes]] = {}

    def contents(folder: Path) -> dict[Path, bytes]:
        return {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}

    def watch(folder: Path) -> None:
        before[folder] = contents(folder)

    yield watch
    for folder, files in before.items():
        assert contents(folder) == files
