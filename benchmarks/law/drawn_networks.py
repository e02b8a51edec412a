"""Networks that nobody has looked at, drawn by netgenerate from a seed, with traffic.

A network is a grid, a spider's web or a random one, with sidewalks and crossings, right-hand or
left-hand traffic, junctions of priority, right before left, stop signs or lights, one or two lanes,
and steps of 0.1 to 1 s. Cars and people go from anywhere to anywhere in it.
"""

from __future__ import annotations

import random
import re
from pathlib import Path

from cities import call_sumo

SHAPES = {
    "grid": ("--grid", "--grid.number=4", "--grid.length=120"),
    "web": (
        "--spider",
        "--spider.arm-number=5",
        "--spider.circle-number=3",
        "--spider.omit-center",
    ),
    "random": ("--rand", "--rand.iterations=40", "--rand.min-distance=60"),
}
JUNCTIONS = ("priority", "right_before_left", "allway_stop", "traffic_light")
STEPS = (0.1, 0.2, 0.5, 1.0)  # [s]
LASTS, WINDOW = 600, 300.0  # [s] of traffic, and in which the cars that are taken over depart
CAR_EVERY, PERSON_EVERY = 2, 1  # [s]
_EDGE = re.compile(r'<edge id="([^":]+)" from')


def draw_network(folder: Path, seed: int) -> tuple[Path, str]:
    """Write a network with its traffic; the configuration, and what the network is in words."""
    draws = random.Random(seed)
    shape, junctions = draws.choice(list(SHAPES)), draws.choice(JUNCTIONS)
    lanes, step, left = draws.choice((1, 2)), draws.choice(STEPS), draws.random() < 0.5
    folder.mkdir(parents=True, exist_ok=True)
    network = folder / "net.net.xml"
    options = [*SHAPES[shape], f"--seed={seed}", f"--default-junction-type={junctions}"]
    options += [f"--default.lanenumber={lanes}", f"--lefthand={left}".lower()]
    options += ["--sidewalks.guess", "--crossings.guess", "--walkingareas", "-o", str(network)]
    call_sumo("netgenerate", *options)
    edges = _EDGE.findall(network.read_text(encoding="utf-8"))
    rows = [
        *_departing(draws, edges, CAR_EVERY, '<trip id="c{}" depart="{}" from="{}" to="{}"/>'),
        *_departing(
            draws,
            edges,
            PERSON_EVERY,
            '<person id="p{}" depart="{}"><walk from="{}" to="{}"/></person>',
        ),
    ]
    rows.sort(key=lambda row: int(row.partition('depart="')[2].partition('"')[0]))
    routes = "\n".join(["<routes>", *rows, "</routes>"])
    (folder / "traffic.rou.xml").write_text(routes, encoding="utf-8")
    config = folder / "drawn.sumocfg"
    config.write_text(
        '<configuration><input><net-file value="net.net.xml"/>'
        f'<route-files value="traffic.rou.xml"/></input><time><end value="{LASTS}"/>'
        f'<step-length value="{step}"/></time>'
        '<processing><ignore-route-errors value="true"/></processing></configuration>',
        encoding="utf-8",
    )
    side = "left" if left else "right"
    return config, f"{shape}, {junctions}, lanes: {lanes}, {side}-hand, steps of {step} s"


def _departing(draws: random.Random, edges: list[str], every: int, row: str) -> list[str]:
    return [
        row.format(number, number * every, *draws.sample(edges, 2))
        for number in range(LASTS // every)
    ]
