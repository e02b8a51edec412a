"""The files of a drawn street: sources of its network, demand, and the settings of a run."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import tomlkit

from giveway.scenario_builder.description import KMH, Crossing, Street
from giveway.scenario_files.configuration_text import configuration_of

_REACH: Final = 40.0  # Longest way [m] of people along a pavement, before or after a crossing
_BESIDE: Final = 15.0  # Half of the length [m] along which people cross where nothing is marked
_VERGE: Final = 2.0  # Width [m] of the strip beside a road without pavements
_DEPARTS: Final = [30.0, 60.0]  # Window [s] in which the ego's departure is drawn
_XML: Final = '<?xml version="1.0" encoding="UTF-8"?>\n'

_BUILD: Final = (
    _XML
    + """<configuration>
    <input>
        <node-files value="{name}.nod.xml"/>
        <edge-files value="{name}.edg.xml"/>
        <connection-files value="{name}.con.xml"/>
        <tllogic-files value="{name}.tll.xml"/>
    </input>
    <output>
        <output-file value="{name}.net.xml"/>
    </output>
    <processing>
        <offset.disable-normalization value="true"/>
        <lefthand value="{lefthand}"/>
    </processing>
    <junctions>
        <no-turnarounds value="true"/>
        <walkingareas value="true"/>
    </junctions>
</configuration>
"""
)
_TYPES: Final = """\
    <vType id="car" vClass="passenger" length="4.5" width="1.8"/>
    <vType id="adult" vClass="pedestrian" desiredMaxSpeed="1.394" maxSpeed="2.2"
           speedFactor="normc(1,0.19,0.36,1.58)"/>
"""


def street_files(street: Street, name: str) -> dict[str, str]:
    """Return the files of a scenario, by their names; only its network is still to be built.

    Args:
        street: Description of the street.
        name: Name of the scenario.
    """
    return {
        f"{name}.nod.xml": _nodes(street),
        f"{name}.edg.xml": _edges(street),
        f"{name}.con.xml": _connections(street),
        f"{name}.tll.xml": _programmes(street),
        f"{name}.netccfg": _BUILD.format(name=name, lefthand=str(street.traffic == "left").lower()),
        f"{name}.rou.xml": _routes(street),
        f"{name}.sumocfg": configuration_of(
            name, street.demand.duration, step=0.1, routes=[f"{name}.rou.xml"]
        ),
        f"{name}.giveway.toml": _settings(street),
    }


def _stations(street: Street) -> list[float]:
    """Return the ends and the middles of the crossings [m], from west to east."""
    return [0.0, *(each.position for each in street.crossings), street.length]


def _edge_names(street: Street, way: str) -> list[str]:
    """Return the edges of one direction, ``east`` or ``west``, from west to east."""
    count = len(street.crossings) + 1
    numbers = range(1, count + 1) if way == "east" else range(count, 0, -1)
    return [f"{way}_{number}" for number in numbers]


def _nodes(street: Street) -> str:
    """Return the nodes; each end has one per direction, so that nobody turns there."""
    node = '    <node id="{}" x="{:g}" y="{:g}" type="{}"/>\n'.format
    types = {"zebra": "priority", "signals": "traffic_light"}
    ends = [("west_end", 0.0), ("east_end", street.length)]
    lines = [
        node(f"{end}_{side}", x, y, "dead_end")
        for end, x in ends
        for side, y in (("south", -0.1), ("north", 0.1))
    ]
    for number, each in enumerate(street.crossings, start=1):
        lines.append(node(f"crossing_{number}", each.position, 0.0, types[each.kind]))
    return f"{_XML}<nodes>\n{''.join(lines)}</nodes>\n"


def _edges(street: Street) -> str:
    """Return the edges; the line drawn is the middle of the road."""
    sidewalk = f' sidewalkWidth="{street.pavement:g}"' if street.pavement else ""
    lines = []
    for way, side in street.sides.items():
        count = len(street.crossings)
        inner = [f"crossing_{number}" for number in range(1, count + 1)]
        ends = pairwise([f"west_end_{side}", *inner, f"east_end_{side}"])
        stations = pairwise(_stations(street))
        for name, nodes, places in zip(_edge_names(street, way), ends, stations, strict=True):
            step = 1 if way == "east" else -1
            (start, end), (x_start, x_end) = nodes[::step], places[::step]
            lines.append(
                f'    <edge id="{name}" from="{start}" to="{end}" numLanes="{street.lanes}" '
                f'speed="{street.speed / KMH:.2f}" width="{street.lane_width:g}"{sidewalk} '
                f'shape="{x_start:g},0 {x_end:g},0"/>\n'
            )
    return f"{_XML}<edges>\n{''.join(lines)}</edges>\n"


def _connections(street: Street) -> str:
    """Return the crossings, each over the edges east of it."""
    eastbound, westbound = _edge_names(street, "east"), _edge_names(street, "west")
    lines = [
        f'    <crossing node="crossing_{number}" edges="{eastbound[number]} {westbound[number]}" '
        f'width="{each.width:g}"{_PRIORITY[each.kind]}/>\n'
        for number, each in enumerate(street.crossings, start=1)
    ]
    return f"{_XML}<connections>\n{''.join(lines)}</connections>\n"


_PRIORITY: Final = {"zebra": ' priority="true"', "signals": ""}


def _programmes(street: Street) -> str:
    """Return a programme for each crossing with traffic lights."""
    phases = "".join(
        f'        <phase duration="{duration:g}" state="{vehicles * 2 * street.lanes}{people}"/>\n'
        for vehicles, people, duration in street.phases
    )
    lines = [
        f'    <tlLogic id="crossing_{number}" type="static" programID="0" offset="0">\n'
        f"{phases}    </tlLogic>\n"
        for number, each in enumerate(street.crossings, start=1)
        if each.kind == "signals"
    ]
    return f"{_XML}<tlLogics>\n{''.join(lines)}</tlLogics>\n"


def _routes(street: Street) -> str:
    """Return the demand: vehicles in both directions, and people over each crossing."""
    demand = street.demand
    lines = []
    if demand.vehicles:
        for way, step in (("east", 1), ("west", -1)):
            edges = _edge_names(street, way)[::step]
            lines.append(
                f'    <flow id="{way}bound" type="car" from="{edges[0]}" to="{edges[-1]}" '
                f'{_span(street, demand.vehicles)} departLane="best" departSpeed="max"/>\n'
            )
    if demand.people:
        for number, each in enumerate(street.crossings):
            lines += _people(street, number, each)
    return f"{_XML}<routes>\n{_TYPES}{''.join(lines)}</routes>\n"


def _span(street: Street, hourly: float) -> str:
    """Return the attributes of a flow with departures at random."""
    return f'begin="0" end="{street.demand.duration:g}" period="exp({hourly / 3600.0:.6g})"'


def _people(street: Street, number: int, crossing: Crossing) -> list[str]:
    """Return the flows over one crossing, from each corner to the opposite one.

    Everybody walks less than half of the way to the next crossing, so that this one is the
    nearest.
    """
    stations = _stations(street)
    reach = {
        "west": min(_REACH, 0.4 * (crossing.position - stations[number])),
        "east": min(_REACH, 0.4 * (stations[number + 2] - crossing.position)),
    }
    lines = []
    for side, other in (("south", "north"), ("north", "south")):
        for start, end in (("west", "east"), ("east", "west")):
            origin, begin = _place(street, side, start, number, reach)
            destination, finish = _place(street, other, end, number, reach)
            lines.append(
                f'    <personFlow id="{side}_{start}_{number + 1}" type="adult" '
                f'{_span(street, street.demand.people / 4.0)} departPos="{begin:.1f}">\n'
                f'        <walk from="{origin}" to="{destination}" arrivalPos="{finish:.1f}"/>\n'
                "    </personFlow>\n"
            )
    return lines


def _place(
    street: Street, side: str, arm: str, number: int, reach: dict[str, float]
) -> tuple[str, float]:
    """Return the edge and the position [m] on it of a place beside a crossing.

    Args:
        street: Street.
        side: South or north.
        arm: West or east of the crossing.
        number: Number of crossings west of this one.
        reach: Distance [m] of the place from the crossing on each arm.
    """
    way = "east" if street.sides["east"] == side else "west"
    edge = _edge_names(street, way)[number + (arm == "east")]
    leads_there = way != arm
    return edge, -reach[arm] if leads_there else reach[arm]  # < 0: from the edge's end


def _settings(street: Street) -> str:
    """Return the settings of a run: the ego, and the people who cross where nothing is marked."""
    document = tomlkit.document()
    kinds = [each.kind for each in street.crossings]
    words = [f"{kinds.count(kind)} x {kind}" for kind in ("zebra", "signals") if kind in kinds]
    document["description"] = (
        f"A street of {street.length:g} m, {street.lanes} + {street.lanes} lanes, "
        f"{street.speed:g} km/h, crossings: {', '.join(words) or 'none'}"
    )
    document["ego"] = {
        "route": _edge_names(street, "east"),
        "lane": 1 if street.pavement else 0,
        "depart_time": _DEPARTS,
        "depart_position": 5.0,
        "initial_speed": round(street.speed / KMH, 2),
    }
    if street.demand.people and not street.crossings:
        document["crowd"] = _unmarked(street)
    document["sumo"] = {"seed": "run"}
    return tomlkit.dumps(document)


def _unmarked(street: Street) -> dict[str, Any]:
    """Return the table [crowd] of people who cross half-way, from side to side."""
    middle, width = street.length / 2.0, street.pavement or _VERGE
    x = [middle - _BESIDE, middle + _BESIDE]
    near, far = street.half_width + 0.3, street.half_width + width
    south, north = [x[0], -far, x[1], -near], [x[0], near, x[1], far]
    flows = [
        {"name": name, "from": start, "to": end, "rate": street.demand.people / 2.0, "begin": -60.0}
        for name, start, end in (("northward", south, north), ("southward", north, south))
    ]
    return {"host_edge": "east_1", "pedestrians": 0, "flow": flows}
