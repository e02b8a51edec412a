"""The reading of the part of a SUMO network file that people walk on.

Only the parts for pedestrians are kept, so that a network of 50 MB takes little time and memory.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from giveway.scenario_files.network import read_network
from giveway.walkways.beside_lanes import part_beside
from giveway.walkways.gates import Array

_PEDESTRIAN = "pedestrian"
_CAR = "passenger"
_ON_FOOT = frozenset(("pedestrian", "bicycle"))
_PRIORITY = "MOo"  # States of a link onto a crossing on which people have priority
_DEFAULT_WIDTH = 3.2  # Width [m] of a lane in SUMO that names none


@dataclass(frozen=True)
class PedLane:
    """The lane of an edge on which pedestrians walk.

    ``length`` is SUMO's nominal length, in which positions count; the shape's length may differ.
    """

    id: str
    shape: Array  # (k, 2) [m] centre line, k >= 2
    width: float  # [m] width
    length: float  # [m] nominal length


@dataclass(frozen=True)
class Signal:
    """A traffic-light link that lets people onto a crossing."""

    tls: str
    link: int  # index in the light's state
    crossing: str  # edge id of the crossing


@dataclass(frozen=True)
class WalkEdge:
    """An edge between two junctions and the lane people walk on."""

    id: str
    junctions: tuple[str, str]  # junctions at the beginning and end of the lane
    lane: PedLane
    sidewalk: bool = False  # True if no motor vehicle uses the lane


@dataclass(frozen=True)
class Link:
    """A connection between two places in a junction, or between one and a lane outside.

    SUMO lets people walk it both ways; its direction only says which ends meet.
    """

    source: str  # edge id
    target: str  # edge id
    signal: tuple[str, int] | None  # the light's id and link index
    priority: bool = True  # False if people wait for a gap here and there is no light


@dataclass
class Survey:
    """The part of a network file that concerns walking; edges are listed by id.

    Attributes:
        edges: Normal edges with a lane for pedestrians.
        walkingareas, crossings: Lane of each, whose shape is an area or a centre line. A crossing
            is the part of it that no lane runs along.
        links: Connections with a walkingarea or crossing at one end.
        junctions: Outline (k, 2) [m] of each junction that has one.
        has_sidewalks: True if there is a lane that pedestrians may use and cars may not.
        boundary: Extent x_min, y_min, x_max, y_max [m] in the file, or None if it has none.
    """

    edges: dict[str, WalkEdge] = field(default_factory=dict)
    walkingareas: dict[str, PedLane] = field(default_factory=dict)
    crossings: dict[str, PedLane] = field(default_factory=dict)
    links: list[Link] = field(default_factory=list)
    junctions: dict[str, Array] = field(default_factory=dict)
    has_sidewalks: bool = False
    boundary: tuple[float, float, float, float] | None = None


def survey(net_file: Path) -> Survey:
    """Read a network file, gzipped or not.

    Raises:
        ScenarioError: the file is unreadable, damaged, or no SUMO network.
    """
    reader = _Reader()
    read_network(net_file, reader.tags)
    return reader.survey


class _Reader:
    """Collects a :class:`Survey` from the start tags of a network file."""

    def __init__(self) -> None:
        self.survey = Survey()
        self._edge: dict[str, str] = {}
        self._exclusive = False
        self._junction_now = ""  # junction of the internal lanes that were read last
        self._inside: list[str] = []  # shapes of these lanes
        self.tags = {
            "location": self._location,
            "edge": self._edge_tag,
            "lane": self._lane,
            "junction": self._junction,
            "connection": self._connection,
        }

    def _location(self, attributes: dict[str, str]) -> None:
        x_min, y_min, x_max, y_max = map(float, attributes["convBoundary"].split(","))
        self.survey.boundary = x_min, y_min, x_max, y_max

    def _edge_tag(self, attributes: dict[str, str]) -> None:
        self._edge = attributes
        self._exclusive = False

    def _lane(self, attributes: dict[str, str]) -> None:
        edge = self._edge
        function = edge.get("function")
        if function == "internal":
            self._note(edge["id"], attributes)
            return
        if not _admits(attributes, _PEDESTRIAN):
            return
        found = self.survey
        if function == "walkingarea":
            found.walkingareas[edge["id"]] = _ped_lane(attributes, at_least=1)
        elif function == "crossing":
            found.crossings[edge["id"]] = self._crossing(edge["id"], _ped_lane(attributes))
        else:
            found.has_sidewalks |= not _admits(attributes, _CAR)
            # SUMO uses the first lane for pedestrians only, else the first that they may use.
            exclusive = attributes.get("allow") == _PEDESTRIAN
            if edge["id"] not in found.edges or (exclusive and not self._exclusive):
                ends = edge["from"], edge["to"]
                sidewalk = set(attributes.get("allow", "").split())
                found.edges[edge["id"]] = WalkEdge(
                    edge["id"],
                    ends,
                    _ped_lane(attributes),
                    sidewalk=bool(sidewalk) and sidewalk <= _ON_FOOT,
                )
                self._exclusive = exclusive

    def _note(self, edge: str, attributes: dict[str, str]) -> None:
        """Keep the vehicles' lanes of the junction that is read now, whose crossings come next."""
        junction = edge.rpartition("_")[0]
        if junction != self._junction_now:
            self._junction_now, self._inside = junction, []
        self._inside.append(attributes.get("shape", ""))

    def _crossing(self, edge: str, lane: PedLane) -> PedLane:
        """Return a crossing without the part that a lane runs along."""
        if edge.rpartition("_")[0] != self._junction_now or len(lane.shape) != 2:
            return lane
        shape, width = part_beside(lane.shape, lane.width, map(_points, self._inside))
        return replace(lane, shape=shape, width=width)

    def _junction(self, attributes: dict[str, str]) -> None:
        # Internal junctions have no shape, and the outer ones of dead ends have only a line.
        if attributes.get("shape") and attributes.get("type") != "internal":
            self.survey.junctions[attributes["id"]] = _points(attributes["shape"])

    def _connection(self, attributes: dict[str, str]) -> None:
        source, target = attributes["from"], attributes["to"]
        found = self.survey
        if not (self._walked(source) or self._walked(target)):
            return
        lit = "tl" in attributes
        signal = (attributes["tl"], int(attributes["linkIndex"])) if lit else None
        priority = lit or attributes.get("state", "M") in _PRIORITY
        found.links.append(Link(source, target, signal, priority))

    def _walked(self, edge: str) -> bool:
        return edge in self.survey.walkingareas or edge in self.survey.crossings


def _admits(lane: dict[str, str], vehicle_class: str) -> bool:
    """Return whether a lane's ``allow`` and ``disallow`` let a class use it, as SUMO reads them."""
    allow = lane.get("allow")
    if allow:
        return allow == "all" or vehicle_class in allow.split()
    disallow = lane.get("disallow", "")
    return disallow != "all" and vehicle_class not in disallow.split()


def _ped_lane(attributes: dict[str, str], at_least: int = 2) -> PedLane:
    shape = _points(attributes["shape"])
    if len(shape) < at_least:
        raise ValueError(f"lane '{attributes['id']}' has {len(shape)} point(s)")
    width = float(attributes.get("width", _DEFAULT_WIDTH))
    return PedLane(attributes["id"], shape, width, float(attributes["length"]))


def _points(text: str) -> Array:
    """Return the points (k, 2) of a SUMO shape, without heights and repeated points."""
    points = np.array([[*map(float, p.split(",")[:2])] for p in text.split()], dtype=np.float64)
    points = points.reshape(-1, 2)
    if not np.isfinite(points).all():
        raise ValueError(f"shape '{text[:40]}' is not finite")
    if len(points) > 2:
        moved = np.hypot(*np.diff(points, axis=0).T) > 1e-6
        kept = points[np.concatenate([[True], moved])]
        points = kept if len(kept) >= 2 else points[[0, -1]]
    return points
