"""Small networks on which roads meet, built by netconvert: for campaigns of drives in traffic.

drop, zipper  a === two lanes, 200 m === b --- one lane --- c
ramp          a ---------- m === two lanes, 130 m === b --- one lane --- c
              r ----------'     the ramp's lane is the right one, which ends
crossroads    two roads of one lane each way; the one along x has priority where anybody has
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from cities import call_sumo

if TYPE_CHECKING:
    from pathlib import Path

ARM = 150.0  # [m] of road on each side of a crossroads
CROSSROADS = ("priority", "priority_stop", "traffic_light", "allway_stop", "right_before_left")
_ARMS = {"w": (-1, 0), "n": (0, 1), "e": (1, 0), "s": (0, -1)}  # clockwise
_TURNS = {"left": 1, "straight": 2, "right": 3}  # arms clockwise from where one comes from
_BUSY, _QUIET = 0.08, 0.03  # [1/s] vehicles that go straight on along the main and the side road
_TURNING = 0.015  # [1/s] that turn, from each arm to each side


class Way(NamedTuple):
    """A route through a network on which an ego meets others."""

    name: str
    place: str  # which network
    route: tuple[str, ...]
    lane: int


class _Flow(NamedTuple):
    route: tuple[str, ...]
    rate: float  # [1/s]


class _Place(NamedTuple):
    nodes: dict[str, tuple[float, float, str]]  # x, y [m] and SUMO's type of junction
    edges: dict[str, tuple[str, str, int, int]]  # from, to, lanes, priority
    links: tuple[tuple[str, str, int, int], ...]  # edges and lanes; none: netconvert's choice
    flows: tuple[_Flow, ...]


_TWO = {"ab": ("a", "b", 2, 5), "bc": ("b", "c", 1, 5)}
_ROAD = (_Flow(("ab", "bc"), 0.6),)


def _narrowing(kind: str, *lanes: int) -> _Place:
    nodes = {"a": (0, 0, "priority"), "b": (200, 0, kind), "c": (400, 0, "priority")}
    return _Place(nodes, _TWO, tuple(("ab", "bc", lane, 0) for lane in lanes), _ROAD)


def _crossroads(kind: str) -> _Place:
    nodes = {name: (x * ARM, y * ARM, "priority") for name, (x, y) in _ARMS.items()}
    edges = {}
    for name, (_, y) in _ARMS.items():
        edges[f"{name}_in"] = (name, "c", 1, 1 + (y == 0))
        edges[f"{name}_out"] = ("c", name, 1, 1 + (y == 0))
    flows = []
    for name, (_, y) in _ARMS.items():
        for turn in _TURNS:
            straight = _BUSY if y == 0 else _QUIET
            flows.append(_Flow(_across(name, turn), straight if turn == "straight" else _TURNING))
    return _Place({**nodes, "c": (0, 0, kind)}, edges, (), tuple(flows))


def _across(arm: str, turn: str) -> tuple[str, str]:
    arms = list(_ARMS)
    return f"{arm}_in", f"{arms[(arms.index(arm) + _TURNS[turn]) % len(arms)]}_out"


_PLACES = {
    "drop": _narrowing("priority", 1),
    "zipper": _narrowing("zipper", 0, 1),
    "ramp": _Place(
        {
            "a": (0, 0, "priority"),
            "r": (0, -60, "priority"),
            "m": (120, 0, "priority"),
            "b": (250, 0, "priority"),
            "c": (400, 0, "priority"),
        },
        {
            "am": ("a", "m", 1, 5),
            "rm": ("r", "m", 1, 3),
            "mb": ("m", "b", 2, 5),
            "bc": ("b", "c", 1, 5),
        },
        (("am", "mb", 0, 1), ("rm", "mb", 0, 0), ("mb", "bc", 1, 0)),
        (_Flow(("am", "mb", "bc"), 0.3), _Flow(("rm", "mb", "bc"), 0.2)),
    ),
    **{kind: _crossroads(kind) for kind in CROSSROADS},
}

WAYS = (
    Way("from the lane that ends", "drop", ("ab", "bc"), 0),
    Way("from the right", "zipper", ("ab", "bc"), 0),
    Way("from the left", "zipper", ("ab", "bc"), 1),
    Way("from the ramp", "ramp", ("rm", "mb", "bc"), 0),
    Way("on the road", "ramp", ("am", "mb", "bc"), 0),
    *(
        Way(f"{turn} from the {road} road", kind, _across(arm, turn), 0)
        for kind in CROSSROADS
        for road, arm in (("main", "w"), ("side", "s"))
        for turn in _TURNS
    ),
)


def build(place: str, folder: Path) -> Path:
    """Write a network and its traffic, whose departures SUMO draws; its .sumocfg.

    Args:
        place: one that a :class:`Way` names.
        folder: a new one for its files.
    """
    nodes, edges, links, flows = _PLACES[place]
    node = '<node id="{}" x="{}" y="{}" type="{}"/>'
    edge = '<edge id="{}" from="{}" to="{}" numLanes="{}" priority="{}" speed="13.9"/>'
    link = '<connection from="{}" to="{}" fromLane="{}" toLane="{}"/>'
    flow = (
        '<flow id="f{}" begin="0" end="300" probability="{}" departSpeed="max" '
        'departLane="random"><route edges="{}"/></flow>'
    )
    parts = {
        "nodes": [node.format(name, *rest) for name, rest in nodes.items()],
        "edges": [edge.format(name, *rest) for name, rest in edges.items()],
        "connections": [link.format(*one) for one in links],
        "routes": [flow.format(i, f.rate, " ".join(f.route)) for i, f in enumerate(flows)],
    }
    folder.mkdir(parents=True)
    for kind, lines in parts.items():
        (folder / f"{kind}.xml").write_text(f"<{kind}>{''.join(lines)}</{kind}>", encoding="utf-8")
    given = ["-n", folder / "nodes.xml", "-e", folder / "edges.xml"]
    given += ["-x", folder / "connections.xml"] if links else []
    call_sumo("netconvert", *given, "--no-turnarounds", "-o", folder / "road.net.xml")
    config_file = folder / "road.sumocfg"
    config_file.write_text(
        '<configuration><input><net-file value="road.net.xml"/><route-files value="routes.xml"/>'
        '</input><time><step-length value="0.1"/></time></configuration>',
        encoding="utf-8",
    )
    return config_file
