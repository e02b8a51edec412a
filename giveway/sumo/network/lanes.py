"""The lanes of the running network: the path along a route, and the outlines to draw."""

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from giveway.errors import ScenarioError
from giveway.geometry.kernel import Array
from giveway.geometry.path import points_at, stations_of
from giveway.scenario_files.right_of_way import stop_offsets
from giveway.sumo.network.heights import Height, heights_of
from giveway.sumo.network.internal_lanes import lanes_inside
from giveway.sumo.network.lane_path import (
    LanePath,
    LaneWidth,
    Light,
    Passage,
    SpeedLimit,
)
from giveway.sumo.network.pedestrian_crossings import Crossing, crossings
from giveway.sumo.network.shared_lanes import Merging, mergings

CHANGE_LENGTH = 30.0  # Length [m] of a lane change
_WALKINGAREA = re.compile(r"^:.*_w\d+_0$")  # SUMO's names; their shape is the outline itself
_SAMPLE = 1.0  # Distance [m] between the points of a lane change


class Link(NamedTuple):
    """A link from a lane over a junction to the next edge's lane."""

    lane: str
    via: tuple[str, ...]  # lanes inside the junction


class Lanes:
    """The lanes of the network, read through libsumo while a simulation runs.

    Args:
        sumo: The libsumo module, as ``SumoSession`` owns it.
        config_file: The scenario, for messages.
        net_file: File of the network, or None if no stop line is before its lane's end.

    Attributes:
        shape: Function that returns the centre line (k, 2) [m] of a lane.
        length: Function that returns the length [m] of a lane's centre line.
        onwards: Function that returns the lanes right after a lane, in the junction or behind it,
            towards an edge.
    """

    def __init__(self, sumo: Any, config_file: Path, net_file: Path | None = None) -> None:
        self._sumo, self._config_file, self._net_file = sumo, config_file, net_file
        self._edges = frozenset(sumo.edge.getIDList())
        self.shape = cache(self._shape)
        self.length = cache(lambda lane: _length(self.shape(lane)))
        self.onwards = cache(self._onwards)

    def along(
        self,
        edges: Sequence[str],
        lane: int | None,
        *,
        kind: str = "passenger",
        start: float = 0.0,
        by: Mapping[int, int] | None = None,
    ) -> LanePath:
        """Return the path along ``edges``, junctions included, with few lane changes.

        Args:
            edges: Edges of the route.
            lane: Index of the lane to start on, or None for the best one.
            kind: SUMO's vehicle class.
            start: Station [m] on the first lane at which the vehicle starts, before lane changes.
            by: Lane on which to leave an edge, by the edge's index in the route. It is used if the
                path can go on from there.

        Raises:
            ScenarioError: an edge or lane does not exist or is not for such vehicles, or the
                edges do not connect.
        """
        for edge in edges:
            if edge not in self._edges:
                raise ScenarioError(
                    f"{self._config_file}: ego route: no edge '{edge}' in the network"
                )
        first = self._start_lanes(edges[0], lane, kind)
        pairs, links = self._cheapest(edges, first, kind, by or {})
        points: list[Array] = []
        lights: list[Light] = []
        begins: list[float] = []
        limits: list[SpeedLimit] = []
        passages: list[Passage] = []
        heights: list[Height] = []
        widths: list[LaneWidth] = []
        driven = 0.0
        for number, (entry, leave) in enumerate(pairs):
            shape = self._changing(edges[number], entry, leave, start if number == 0 else 0.0)
            points.append(shape)
            begins.append(driven)
            own = {f"{edges[number]}_{i}" for i in (entry, leave)}
            limits.append(SpeedLimit(driven, min(map(self.speed_limit, own)), tuple(sorted(own))))
            widths.append(LaneWidth(driven, min(map(self.width, own))))
            heights += self._heights(f"{edges[number]}_{entry}", driven, _length(shape))
            driven += _length(shape)
            if number < len(links):
                link = links[number]
                light = self.signals.get((f"{edges[number]}_{leave}", link.lane))
                offset = self.stop_offset(f"{edges[number]}_{leave}", kind)
                if light is not None:
                    lights.append(Light(driven - offset, *light))
                begins_inside = self._begins_inside(link, driven, shape[-1:])
                speeds = map(self.speed_limit, link.via)
                limits.extend(map(SpeedLimit, begins_inside, speeds, [(v,) for v in link.via]))
                widths.extend(map(LaneWidth, begins_inside, map(self.width, link.via)))
                inside = [self.shape(name) for name in link.via]
                for name, begin in zip(link.via, begins_inside, strict=True):
                    heights += self._heights(name, begin, self.length(name))
                following = self.shape(link.lane)
                onwards = np.concatenate([shape[-1:], *inside, following[:1]])
                points.extend(inside)
                line, driven = driven, driven + _length(onwards)
                if link.via:
                    waiting = tuple(begins_inside[1:])
                    passages.append(Passage(line, driven, link.via, waiting, offset))
        return LanePath(
            np.concatenate(points),
            tuple(lights),
            f"{edges[0]}_{pairs[0][0]}",
            tuple(begins),
            tuple(limits),
            tuple(passages),
            tuple((f"{e}_{i}", f"{e}_{j}") for e, (i, j) in zip(edges, pairs, strict=True)),
            tuple(heights),
            tuple(widths),
        )

    def _heights(self, lane: str, begin: float, length: float) -> Iterator[Height]:
        return heights_of(self._sumo, lane, self.shape(lane), begin, length)

    def mergings(self, lane_path: LanePath) -> tuple[Merging, ...]:
        """Return the places where other lanes join the lanes of a path, in driving order."""
        return mergings(self._sumo, lane_path.lanes, lane_path.edges, self.shape)

    @cached_property
    def crossings(self) -> tuple[Crossing, ...]:
        """All crossings of the network."""
        return crossings(self._sumo, self.signals)

    def width(self, lane: str) -> float:
        """Width [m] of a lane."""
        return float(self._sumo.lane.getWidth(lane))

    def _shape(self, lane: str) -> Array:
        return np.array(self._sumo.lane.getShape(lane), dtype=np.float64)

    def speed_limit(self, lane: str) -> float:
        """Return the speed limit [m/s] of a lane, for any vehicle."""
        return float(self._sumo.lane.getMaxSpeed(lane))

    @cached_property
    def limits_change(self) -> bool:
        """True if the network has variable speed signs or calibrators, which change limits."""
        return any(d.getIDList() for d in (self._sumo.variablespeedsign, self._sumo.calibrator))

    def stop_offset(self, lane: str, kind: str = "passenger") -> float:
        """Return the distance [m] of a lane's stop line for a vehicle class from the lane's end."""
        offsets = {} if self._net_file is None else stop_offsets(self._net_file)
        offset = offsets.get(lane) or offsets.get(lane.rpartition("_")[0])
        if offset is None or not offset.holds_for(kind):
            return 0.0
        return offset.value * self.length(lane) / float(self._sumo.lane.getLength(lane))

    def point(self, lane: str, position: float) -> tuple[float, float]:
        """Return x, y [m] of a ``position`` [m] in SUMO's metres along a lane."""
        share = position / max(float(self._sumo.lane.getLength(lane)), 1e-3)
        x, y = _at(self.shape(lane), np.array([share]))[0]
        return float(x), float(y)

    def edges_after(self, edge: str, kind: str) -> list[str]:
        """Return the edges to which vehicles of SUMO's class ``kind`` can go on from ``edge``."""
        lanes = [f"{edge}_{i}" for i in self._drivable(edge, kind)]
        targets = [link[0] for lane in lanes for link in self._sumo.lane.getLinks(lane)]
        return [
            str(self._sumo.lane.getEdgeID(target))
            for target in targets
            if admits(self._sumo, target, kind)
        ]

    def edges_before(self, edge: str) -> frozenset[str]:
        """Return the edges that end where ``edge`` begins."""
        junction = self._sumo.edge.getFromJunction(edge)
        return frozenset(self._sumo.junction.getIncomingEdges(junction))

    def _onwards(self, lane: str, edge: str) -> tuple[str, ...]:
        links = self._sumo.lane.getLinks(lane)
        leading = [link for link in links if self._sumo.lane.getEdgeID(link[0]) == edge]
        return tuple(link[4] or link[0] for link in leading)

    def out_of_junction(self, lane: str) -> tuple[str, ...]:
        """Return the lanes after one inside a junction, up to the first one outside."""
        lanes: list[str] = []
        while lane.startswith(":"):
            links = self._sumo.lane.getLinks(lane)
            if not links:
                break
            lane = links[0][4] or links[0][0]
            lanes.append(lane)
        return tuple(lanes)

    def _start_lanes(self, edge: str, lane: int | None, kind: str) -> list[int]:
        count = int(self._sumo.edge.getLaneNumber(edge))
        if lane is not None and lane >= count:
            raise ScenarioError(
                f"{self._config_file}: ego lane {lane}: edge '{edge}' has {count} lane(s); "
                f"expected 0 to {count - 1}"
            )
        drivable = self._drivable(edge, kind)
        if (lane is None and not drivable) or (lane is not None and lane not in drivable):
            named = f"lane '{edge}_{lane}' is" if lane is not None else f"edge '{edge}' is"
            users = "cars" if kind == "passenger" else f"vehicles of class '{kind}'"
            raise ScenarioError(
                f"{self._config_file}: ego lane {lane}: {named} not for {users}; "
                f"expected one of {drivable or 'no lane of this edge'}, name it with --ego-lane"
            )
        return drivable if lane is None else [lane]

    def _drivable(self, edge: str, kind: str) -> list[int]:
        count = int(self._sumo.edge.getLaneNumber(edge))
        return [i for i in range(count) if admits(self._sumo, f"{edge}_{i}", kind)]

    def _cheapest(
        self, edges: Sequence[str], first: list[int], kind: str, by: Mapping[int, int]
    ) -> tuple[list[tuple[int, int]], list[Link]]:
        """Find the lanes on which to enter and leave each edge, and the links between them."""
        # best[lane]: changes so far, (entry, leave) of each edge before, links taken
        best: dict[int, tuple[int, list[tuple[int, int]], list[Link]]]
        best = {lane: (0, [], []) for lane in first}
        for number, (edge, following) in enumerate(itertools.pairwise(edges)):
            reached: dict[int, tuple[int, list[tuple[int, int]], list[Link]]] = {}
            lanes = self._drivable(edge, kind) or sorted(best)
            wanted = by.get(number)
            if wanted in lanes and self._links(f"{edge}_{wanted}", following):
                lanes = [wanted]
            for leave in lanes:
                for link in self._links(f"{edge}_{leave}", following):
                    target = int(link.lane.rpartition("_")[2])
                    for entry, (changes, pairs, links) in best.items():
                        cost = changes + abs(leave - entry)
                        if target not in reached or cost < reached[target][0]:
                            taken = [*pairs, (entry, leave)]
                            reached[target] = (cost, taken, [*links, link])
            if not reached:
                raise ScenarioError(
                    f"{self._config_file}: ego route: edge '{edge}' has no connection to edge "
                    f"'{following}'; choose another lane or route"
                )
            best = reached
        lane, (_, pairs, links) = min(best.items(), key=lambda item: (item[1][0], item[0]))
        last = by.get(len(edges) - 1)
        leave = last if last in self._drivable(edges[-1], kind) else lane
        return [*pairs, (lane, leave)], links

    def _links(self, lane: str, edge: str) -> list[Link]:
        """Return the links from ``lane`` over the junction to ``edge``."""
        return [
            Link(link[0], lanes_inside(self._sumo, link[4]))
            for link in self._sumo.lane.getLinks(lane)
            if self._sumo.lane.getEdgeID(link[0]) == edge
        ]

    def _begins_inside(self, link: Link, station: float, end: Array) -> list[float]:
        """Return the stations [m] of the lanes of ``link``, from ``station`` at ``end`` (1, 2)."""
        begins = []
        for name in link.via:
            begins.append(station)
            shape = self.shape(name)
            station += _length(np.concatenate([end, shape]))
            end = shape[-1:]
        return begins

    @cached_property
    def signals(self) -> dict[tuple[str, str], tuple[str, int]]:
        """The traffic light and movement of each link from lane to lane, if a light governs it."""
        return {
            (source, target): (system, index)
            for system in self._sumo.trafficlight.getIDList()
            for index, links in enumerate(self._sumo.trafficlight.getControlledLinks(system))
            for source, target, _ in links
        }

    def _changing(self, edge: str, entry: int, leave: int, start: float) -> Array:
        """Return the centre line from lane ``entry`` over to lane ``leave`` of one edge."""
        before = self.shape(f"{edge}_{entry}")
        if entry == leave:
            return before
        after = self.shape(f"{edge}_{leave}")
        length = _length(before)
        begin = min(max(start, 0.0), length)
        span = min(abs(leave - entry) * CHANGE_LENGTH, length - begin)
        samples = np.linspace(0.0, length, max(2, round(length / _SAMPLE)))
        share = np.clip((samples - begin) / max(span, 1e-3), 0.0, 1.0)
        weight = (share * share * (3.0 - 2.0 * share))[:, None]  # a smooth S
        return (1.0 - weight) * _at(before, samples / length) + weight * _at(
            after, samples / length
        )

    def areas(self) -> tuple[Array, ...]:
        """Closed outlines (k, 2) [m] of all lanes to drive and walk on, junctions included."""
        outlines = []
        for name in self._sumo.lane.getIDList():
            shape = self.shape(name)
            if _WALKINGAREA.search(name):
                outlines.append(np.concatenate([shape, shape[:1]]))
            elif len(shape) > 1:
                outlines.append(lane_area(shape, self.width(name)))
        return tuple(outlines)


def admits(sumo: Any, lane: str, kind: str) -> bool:
    """Return whether vehicles (or persons) of SUMO's class ``kind`` may use ``lane``."""
    allowed = sumo.lane.getAllowed(lane)
    return (not allowed or kind in allowed) and kind not in sumo.lane.getDisallowed(lane)


def _length(points: Array) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def _at(points: Array, shares: Array) -> Array:
    """Return the points of a polyline at ``shares`` in [0, 1] of its length."""
    along = stations_of(points)
    return points_at(points, along, shares * along[-1])


def lane_area(centre_line: Array, width: float) -> Array:
    """Return the closed outline (2k + 1, 2) [m] of a lane.

    Args:
        centre_line: Centre line (k, 2) [m], k >= 2.
        width: Width [m].
    """
    along = np.gradient(centre_line, axis=0)
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-12)
    left = np.column_stack([-along[:, 1], along[:, 0]]) / length[:, None] * (width / 2)
    outline = np.concatenate([centre_line + left, (centre_line - left)[::-1]])
    return np.concatenate([outline, outline[:1]])
