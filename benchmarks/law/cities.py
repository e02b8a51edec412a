"""Grid cities of constant density, built by netgenerate: for the benchmarks."""

from __future__ import annotations

import importlib.util
import os
import random
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

BLOCK = 100.0  # [m]
WALKERS_PER_STREET = 10
WALK_LENGTH = (3, 30)  # streets
TURNOVER = 1200.0  # [s] in which as many depart anew as there are
LASTS = 3600.0  # [s] until nobody departs any more


class City(NamedTuple):
    """A scenario on disk."""

    config_file: Path
    ego_route: str


def build_city(folder: Path, walkers: int, turnover: float = TURNOVER) -> City:
    """Build a city for so many walkers."""
    side = 2
    while 2 * side * (side - 1) * WALKERS_PER_STREET < walkers:
        side += 1
    netgenerate(folder / "city.net.xml", side)
    draw = random.Random(walkers)
    corners = {(i, j) for i in range(side) for j in range(side)}
    lines = ['<vType id="walker" vClass="pedestrian" speedDev="0.15"/>']
    for number, depart in enumerate(departures(walkers, turnover)):
        route = stroll(draw, corners, draw.randint(*WALK_LENGTH))
        lines.append(
            f'<person id="p{number}" type="walker" depart="{depart:.2f}" departPos="random">'
            f'<walk edges="{route}" arrivalPos="{draw.uniform(5.0, 60.0):.1f}"/></person>'
        )
        if depart == 0.0 and number % WALKERS_PER_STREET == 0:
            lines.append(
                f'<vehicle id="car{number}" depart="0" departPos="random_free" departLane="best">'
                f'<route edges="{stroll(draw, corners, 200)}"/></vehicle>'
            )
    lines.sort(key=lambda line: float(line.partition('depart="')[2].partition('"')[0] or -1.0))
    (folder / "city.rou.xml").write_text(
        "\n".join(["<routes>", *lines, "</routes>"]), encoding="utf-8"
    )
    config_file = folder / "city.sumocfg"
    config_file.write_text(
        '<configuration><input><net-file value="city.net.xml"/>'
        '<route-files value="city.rou.xml"/></input><time><step-length value="0.1"/></time>'
        '<processing><pedestrian.model value="striping"/></processing></configuration>',
        encoding="utf-8",
    )
    return City(config_file, stroll(draw, corners, 100).replace(" ", ","))


def netgenerate(network: Path, side: int) -> None:
    """Write a grid of ``side`` times ``side`` signalled junctions."""
    command = ["--grid", f"--grid.number={side}"]
    command += [f"--grid.length={BLOCK}", "--default.lanenumber=1", "--sidewalks.guess"]
    command += ["--crossings.guess", "--walkingareas", "--default-junction-type=traffic_light"]
    command += ["--default.speed=13.89", "--no-turnarounds", "-o", str(network)]
    call_sumo("netgenerate", *command)


def call_sumo(program: str, *options: str | Path) -> None:
    """Run one of SUMO's programs that build networks."""
    package = importlib.util.find_spec("sumo")
    if package is None or package.origin is None:
        raise SystemExit(f"no {program}: pip install 'giveway[build]'")
    home = Path(package.origin).parent
    command = [str(home / "bin" / program), *map(str, options)]
    environment = os.environ | {"SUMO_HOME": str(home)}
    done = subprocess.run(command, check=False, capture_output=True, text=True, env=environment)
    if done.returncode:
        raise SystemExit(f"{program}: {' '.join(done.stderr.split())}")


def departures(walkers: int, turnover: float) -> Iterator[float]:
    """Everybody at once, then as many as arrive."""
    yield from [0.0] * walkers
    for k in range(round(walkers * LASTS / turnover)):
        yield (k + 0.5) * turnover / walkers


def stroll(draw: random.Random, corners: set[tuple[int, int]], length: int) -> str:
    """A random walk along ``length`` streets that never turns back unless it has to."""
    here = draw.choice(sorted(corners))
    before, edges = here, []
    for _ in range(length):
        i, j = here
        around = [(i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)]
        onwards = [corner for corner in around if corner in corners and corner != before]
        before, here = here, draw.choice(onwards)
        edges.append(f"{name(before)}{name(here)}")
    return " ".join(edges)


def name(corner: tuple[int, int]) -> str:
    """As netgenerate calls it."""
    return f"{chr(ord('A') + corner[0])}{corner[1]}"
