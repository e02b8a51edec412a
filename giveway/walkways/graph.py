"""The graph of the walkingareas and crossings around a junction.

A *portal* is where a lane or a crossing meets a walkingarea. People go from portal to portal inside
a walkingarea, and along a crossing from its one portal to the other. Lanes outside of junctions are
not edges of this graph, so that a route found in it never leaves its junction.
"""

import heapq
import itertools
from collections import defaultdict
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from giveway.walkways.gates import TRACKS, Array, gate, turned
from giveway.walkways.inside import Interior, is_line
from giveway.walkways.polyline import Polyline, usable_half_width
from giveway.walkways.reading import Link, PedLane, Signal, Survey

_KERB = 0.4  # Distance [m] from the roadway at which people wait for green


class End(NamedTuple):
    """One end of a lane or crossing, given by its edge."""

    edge: str
    last: bool  # True for the end of its shape, False for its beginning


@dataclass(frozen=True)
class Portal:
    """A place where an end of a lane or crossing meets a walkingarea."""

    end: End
    area: str
    gate: Array  # (1, 7) gate, walked into the area


class Step(NamedTuple):
    """The remaining distance from a portal, and the next portal."""

    distance: float  # [m] remaining distance
    portal: int  # index of the next portal, or -1 if the portal is the target


@dataclass(frozen=True)
class Tree:
    """The shortest routes from the portals of a junction to the end of one lane.

    Areas and crossings alternate, so that each portal has two roles: people come into its area
    there, or leave it.
    """

    coming: dict[int, Step]  # steps by portal; the next portal is the one at which the area is left
    # steps by portal; the next portal is the one at the crossing's other end
    leaving: dict[int, Step]


class WalkGraph:
    """The portals, and the gates of the routes between them; each is built when it is first needed.

    Functions that keep their results: ``interior`` of a walkingarea, ``portals_of`` an end,
    ``portals_in`` a walkingarea, ``towards`` an end, and ``across`` a crossing.

    Args:
        survey: Contents of the network file.
    """

    def __init__(self, survey: Survey) -> None:
        self._survey = survey
        self.lines = {
            name: Polyline.through(edge.lane.shape) for name, edge in survey.edges.items()
        }
        self._crossing_lines = {
            name: Polyline.through(lane.shape) for name, lane in survey.crossings.items()
        }
        self.signals: list[Signal] = []
        self.gap_crossings: list[str] = []  # edges of the crossings at which people wait for a gap
        self._signal_of: dict[tuple[str, str], int] = {}
        self._links: dict[End, list[str]] = defaultdict(list)
        self._ends_at: dict[str, list[End]] = defaultdict(list)
        for link in survey.links:
            self._add(link)
        self._inherit_signals()
        self._number_gaps()
        self._portals: list[Portal] = []
        self.interior = cache(self._interior)
        self.portals_of = cache(self._portals_of)
        self.portals_in = cache(self._portals_in)
        self.towards = cache(self._towards)
        self._inside: dict[tuple[int, int, int], Array] = {}
        self.across = cache(self._across)

    def _add(self, link: Link) -> None:
        """Note which ends meet; a signal counts for entering a crossing from an area."""
        survey = self._survey
        if link.target in survey.walkingareas:
            area, end = link.target, End(link.source, last=True)
        elif link.source in survey.walkingareas:
            area, end = link.source, End(link.target, last=False)
        else:
            return
        if end.edge not in survey.edges and end.edge not in survey.crossings:
            return  # the end of a lane that pedestrians may not use
        self._links[end].append(area)
        self._ends_at[area].append(end)
        if link.signal is not None and end.edge in survey.crossings:
            self._signal_of[end.edge, area] = self._signal(*link.signal, end.edge)
        elif not link.priority and end.edge in survey.crossings:
            self.gap_crossings.append(end.edge)

    def _signal(self, tls: str, index: int, crossing: str) -> int:
        signal = Signal(tls, index, crossing)
        if signal not in self.signals:
            self.signals.append(signal)
        return self.signals.index(signal)

    def _inherit_signals(self) -> None:
        """Use the signal of one end of a crossing also at the other end, if that one has none."""
        for i, signal in enumerate(self.signals):
            for last in (False, True):
                for area in self._links.get(End(signal.crossing, last), ()):
                    self._signal_of.setdefault((signal.crossing, area), i)

    def _number_gaps(self) -> None:
        """Let people wait for a gap at both ends of a crossing; gaps come after the signals."""
        lit = {signal.crossing for signal in self.signals}
        self.gap_crossings = [edge for edge in dict.fromkeys(self.gap_crossings) if edge not in lit]
        for i, edge in enumerate(self.gap_crossings, len(self.signals)):
            for last in (False, True):
                for area in self._links.get(End(edge, last), ()):
                    self._signal_of[edge, area] = i

    def at_dead_end(self, end: End) -> bool:
        """Return whether people turn round at a lane's end on a walkingarea without an area."""
        areas = self._links.get(end, ())
        return bool(areas) and all(is_line(self._survey.walkingareas[area]) for area in areas)

    def _interior(self, area: str) -> Interior:
        """Return the inside of a walkingarea."""
        return Interior(self._survey.walkingareas[area])

    def lane(self, edge: str) -> PedLane:
        """Return the lane of an edge or crossing."""
        known = self._survey.edges.get(edge)
        return self._survey.crossings[edge] if known is None else known.lane

    def line(self, edge: str) -> Polyline:
        """Return the centre line of an edge or crossing."""
        found = self.lines.get(edge)
        return self._crossing_lines[edge] if found is None else found

    # --- portals ------------------------------------------------------------------------------

    def portal(self, index: int) -> Portal:
        """Return the portal with this index."""
        return self._portals[index]

    def _portals_of(self, end: End) -> range:
        """Return the portals at one end of a lane or crossing."""
        first, areas = len(self._portals), dict.fromkeys(self._links.get(end, ()))
        self._portals += [Portal(end, area, self._gate_into(end, area)) for area in areas]
        return range(first, len(self._portals))

    def _portals_in(self, area: str) -> list[int]:
        """Return the portals of a walkingarea."""
        ends = dict.fromkeys(self._ends_at.get(area, ()))
        portals = itertools.chain.from_iterable(self.portals_of(end) for end in ends)
        return [i for i in portals if self._portals[i].area == area]

    def lane_end(self, end: End) -> Array:
        """Return the gate (1, 7) across the end of a lane or crossing, walked out of it."""
        line = self.line(end.edge)
        half_width = usable_half_width(self.lane(end.edge).width)
        if end.last:
            return gate(line.points[-1], line.directions[-1], half_width)
        return gate(line.points[0], -line.directions[0], half_width)

    def _gate_into(self, end: End, area: str) -> Array:
        row = self.lane_end(end)
        if end.edge in self._crossing_lines:
            # People wait on the kerb, and leave the roadway before they turn.
            row = self.interior(area).gate_within(row, _KERB)
        return row

    # --- routes -------------------------------------------------------------------------------

    def _towards(self, target: End) -> Tree:
        """Find the shortest routes to a lane's end from all portals of its junction (Dijkstra)."""
        tree = Tree({}, {})
        heap = [(0.0, i, True, -1) for i in self.portals_of(target)]
        while heap:
            distance, i, leaves, following = heapq.heappop(heap)
            steps = tree.leaving if leaves else tree.coming
            if i in steps:
                continue
            steps[i] = Step(distance, following)
            here = self._portals[i]
            if leaves:
                for j in self.portals_in(here.area):
                    if j != i:
                        onwards = _length(self._portals[j].gate, self.inside(j, i), here.gate)
                        heapq.heappush(heap, (distance + onwards, j, False, i))
            elif here.end.edge in self._crossing_lines:
                onwards = self._crossing_lines[here.end.edge].length
                for j in self.portals_of(End(here.end.edge, not here.end.last)):
                    heapq.heappush(heap, (distance + onwards, j, True, i))
        return tree

    def inside(self, start: int, end: int, track: int = 0) -> Array:
        """Return the gates (k, 7) between two portals of a walkingarea, for people on one track."""
        found = self._inside.get((start, end, track))
        if found is None:
            first, last = self._portals[start], self._portals[end]
            side = track / TRACKS
            found = self.interior(first.area).between(first.gate, turned(last.gate), side)
            self._inside[start, end, track] = found
            self._inside[end, start, -track] = turned(found)
        return found

    def _across(self, start: int, end: int) -> Array:
        """Return the gates (k, 7) of a crossing with both portals; the first has the signal."""
        first, last = self._portals[start], self._portals[end]
        kerb = turned(first.gate)
        kerb[0, 6] = self._signal_of.get((first.end.edge, first.area), -1)
        return np.vstack([kerb, self.along_crossing(first.end), last.gate])

    def along_crossing(self, start: End) -> Array:
        """Return the gates (k, 7) of a crossing's bends, walked from one end to the other."""
        half_width = usable_half_width(self.lane(start.edge).width)
        gates = self._crossing_lines[start.edge].gates(half_width)[1:-1]
        return turned(gates) if start.last else gates

    def follow(self, start: int, tree: Tree, track: int) -> Array:
        """Return the gates (k, 7) up to the target after a portal at which an area is entered."""
        pieces = []
        while True:
            out = tree.coming[start].portal
            pieces.append(self.inside(start, out, track))
            following = tree.leaving[out].portal
            if following < 0:
                return np.vstack([*pieces, turned(self._portals[out].gate)])
            pieces.append(self.across(out, following))
            start = following

    def leave(self, start: int, tree: Tree, track: int) -> Array:
        """Return the gates (k, 7) up to the target from a portal on at which an area is left."""
        following = tree.leaving[start].portal
        if following < 0:
            return turned(self._portals[start].gate)
        return np.vstack([self.across(start, following), self.follow(following, tree, track)])


def _length(start: Array, between: Array, end: Array) -> float:
    """Return the length [m] of the line through the middles of gates."""
    middles = np.vstack([start[:, :2], between[:, :2], end[:, :2]])
    return float(np.hypot(*np.diff(middles, axis=0).T).sum())
