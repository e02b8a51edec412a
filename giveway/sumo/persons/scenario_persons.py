"""The scenario's own persons: taken over where they walk, handed back to SUMO afterwards.

A person keeps everything in SUMO while giveway holds it: plan, type, colour and parameters. A held
person is moved as a ghost (see giveway/sumo/session.py). In SUMO's records its place lies far
outside of its lane: otherwise SUMO's pedestrians would walk round the spot where it was taken over,
and vehicles would wait for ever at a crossing that it has long left.
"""

import contextlib
import enum
import itertools
import math
from collections import Counter
from collections.abc import Container, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.path import angle_to_heading
from giveway.sumo.library import direct
from giveway.sumo.network.footpaths import FootPaths
from giveway.sumo.persons.gap_habits import GapHabit, GapHabits
from giveway.sumo.persons.handover import Handover, Route
from giveway.sumo.persons.lane_records import LaneRecords
from giveway.sumo.persons.observers import of_running
from giveway.sumo.persons.return_places import ReturnPlaces
from giveway.sumo.persons.walk_speeds import WalkSpeeds

_WALKING = 2  # SUMO's number of the walking stage type
_RED_TIME = "junctionModel.jmDriveAfterRedTime"
_SLOWEST = 0.1  # Smallest desired speed [m/s]
_JUMPED = 2.0  # Share of the desired speed above which SUMO has moved a person, who has not walked


def walked(speed: float, usual: float) -> float:
    """Return the speed [m/s] with which a person walks, whatever speed SUMO reports.

    SUMO reports up to 9,999 m/s in the step in which it puts a person onto another lane.

    Args:
        speed: Speed [m/s] that SUMO reports.
        usual: Desired speed [m/s] of the person.
    """
    return speed if speed <= _JUMPED * usual else usual


class Arrival(enum.Enum):
    """The outcome for a person who has reached the end of the route."""

    ARRIVED = "arrived"  # the person leaves SUMO with the next step
    CONTINUED = "continued"  # a stop, a ride or another walk follows in SUMO


@dataclass(frozen=True, slots=True)
class Person:
    """A person as SUMO has it at its present instant."""

    id: str
    type: str
    x: float  # [m] place
    y: float  # [m] place
    heading: float  # [rad], counter-clockwise from +x
    speed: float  # [m/s] speed
    desired_speed: float  # [m/s] positive
    edges: tuple[str, ...]  # remaining normal edges of the present walk, the current one first
    lane: str  # SUMO's present lane, which may lie inside a junction
    arrival_position: float  # [m] position on the last edge at which the walk ends
    stages_left: int  # number of stages after this walk


class ScenarioPersons:
    """The scenario's persons: those that SUMO moves now, and those that giveway moves.

    Args:
        sumo: The libsumo module, with a simulation running.
        ours: Ids of persons that giveway added, which are never touched.

    Attributes:
        held: Ids of the persons that giveway moves now.
        ever_held: Ids of the persons that giveway has ever moved.
        records: Lanes on which the held persons are in SUMO's records.
        counts: Numbers of persons. ``taken`` is the sum of ``handed_back``, ``arrived``,
            ``continued``, ``lost`` and those held; ``lost`` are held persons that something else
            removed from SUMO.
    """

    held: set[str]
    ever_held: set[str]
    counts: Counter[str]

    def __init__(self, sumo: Any, ours: Container[str]) -> None:
        self._sumo = sumo
        self._ours = ours
        self.held = set()
        self.ever_held = set()
        self.counts = Counter(taken=0, handed_back=0, arrived=0, continued=0, lost=0)
        self._free: dict[str, None] = {}  # departed persons that SUMO moves, in order of departure
        self._seen_until = -math.inf  # [s] SUMO's clock when `_free` was last updated
        self._routes: dict[str, Route] = {}
        # persons at the end of their walks, see `arrive`
        self._leaving: dict[str, tuple[int, float]] = {}
        self._put_back: set[str] = set()  # persons handed back since SUMO's last step
        self._paths = FootPaths(sumo)
        observers = of_running(sumo)
        self.records = LaneRecords(sumo, self._paths, observers, self._begin_anew)
        self._speeds = WalkSpeeds.of_running(sumo)
        self._handover = Handover(sumo, self._paths)
        self._handover.sums = observers.edges
        self._places = ReturnPlaces(self._paths, self._handover)
        self._gap_habits = GapHabits(sumo)
        self._position = direct(sumo, "person", "getPosition")

    # --- where everybody is --------------------------------------------------------------------

    def positions(self) -> tuple[list[str], NDArray[np.float64]]:
        """The ids and positions (n, 2) [m] of all departed persons that giveway does not hold.

        Call it once after each SUMO step. After a step without a call, it looks through all persons
        in SUMO.
        """
        self._update()
        try:
            return self._read()
        except self._handover.refusals:  # a person vanished without having arrived
            self._look_at_everybody()
            return self._read()

    def _read(self) -> tuple[list[str], NDArray[np.float64]]:
        ids = list(self._free)
        flat = itertools.chain.from_iterable(map(self._position, ids))
        return ids, np.fromiter(flat, dtype=np.float64, count=2 * len(ids)).reshape(-1, 2)

    def _update(self) -> None:
        simulation = self._sumo.simulation
        now = float(simulation.getTime())
        if now == self._seen_until:
            return
        if now - self._seen_until > 1.5 * simulation.getDeltaT():
            self._look_at_everybody()
        else:
            for name in simulation.getDepartedPersonIDList():
                if name not in self._ours:
                    self._free[name] = None
            for name in simulation.getArrivedPersonIDList():
                self._free.pop(name, None)
                self._leaving.pop(name, None)
                if name in self.held:
                    self._lose(name)
        self._seen_until = now
        self._put_back.clear()
        if self._leaving:
            self._end_overdue()
        self._handover.end_paces()

    def _look_at_everybody(self) -> None:
        present = dict.fromkeys(self._sumo.person.getIDList())
        self._free = {
            name: None
            for name in present
            if name not in self.held and name not in self._ours and name not in self._leaving
        }
        for name in [name for name in self.held if name not in present]:
            self._lose(name)
        for name in [name for name in self._leaving if name not in present]:
            del self._leaving[name]

    def _end_overdue(self) -> None:
        """End the walks that SUMO should have ended in its step."""
        person = self._sumo.person
        for name, (stages_left, begun) in self._leaving.items():
            if person.getStage(name).depart == begun:  # still the same stage
                if stages_left:
                    person.removeStage(name, 0)
                else:
                    person.removeStages(name)
            if stages_left:
                self._free[name] = None
        self._leaving.clear()

    def _lose(self, name: str) -> None:
        self._release(name, "lost")

    def red_times(self) -> dict[str, float]:
        """Return the time [s] from the beginning of red on up to which people of types walk."""
        types = self._sumo.vehicletype
        told = {name: types.getParameter(name, _RED_TIME) for name in types.getIDList()}
        return {name: float(time) for name, time in told.items() if time and float(time) > 0.0}

    # --- taking over --------------------------------------------------------------------------

    def take(self, ids: Sequence[str]) -> list[Person]:
        """Take over those of ``ids`` that walk right now, and skip the others.

        A person that was handed back since SUMO's last step is skipped, too. The persons taken over
        are held from now on: they must be moved in every step of SUMO.
        """
        return [taken for taken in map(self._take, ids) if taken is not None]

    def _take(self, name: str) -> Person | None:
        person = self._sumo.person
        if name not in self._free or name in self._put_back:  # the speed would come from the jump
            return None
        lane = person.getLaneID(name)
        if not lane:  # the person waits
            return None
        stage = person.getStage(name)
        if stage.type != _WALKING:
            return None
        edges, arrival = tuple(stage.edges), float(stage.arrivalPos)
        current = self._paths.index(name, edges, lane, arrival)
        own_speed = self._speeds.speed(name, stage, person.getRemainingStages(name))
        x, y = self._position(name)
        usual = own_speed or float(person.getMaxSpeed(name))
        speed = walked(float(person.getSpeed(name)), usual)
        taken = Person(
            id=name,
            type=person.getTypeID(name),
            x=x,
            y=y,
            heading=angle_to_heading(person.getAngle(name)),
            speed=speed,
            desired_speed=max(usual, speed, _SLOWEST),
            edges=edges[current:],
            lane=lane,
            arrival_position=arrival,
            stages_left=person.getRemainingStages(name) - 1,
        )
        inside = lane.startswith(":")
        hideout = self._paths.lane(taken.edges[0]) if inside else lane
        try:
            if not (inside and self.records.keeps(lane)):
                self._handover.park(name, hideout or lane)
        except self._handover.refusals:
            return None  # the person stands beside its own route, and SUMO could not put it back
        self._routes[name] = Route(
            edges=taken.edges,
            arrival_position=arrival,
            stages_left=taken.stages_left,
            type=taken.type,
            own_speed=own_speed,
            was_inside=inside,
        )
        self.held.add(name)
        self.ever_held.add(name)
        self.records.begin(name, taken.edges)
        del self._free[name]
        self.counts["taken"] += 1
        return taken

    def _begin_anew(self, name: str, edges: tuple[str, ...]) -> None:
        """Let a held person's walk in SUMO begin anew on the first of ``edges``."""
        route = self._routes[name]
        self._handover.restart(name, route, edges)
        self._routes[name] = replace(route, edges=edges, was_inside=False, begun_anew=True)

    def gap_habit(self, walker: Person) -> GapHabit:
        """Return how a person who has just been taken over accepts gaps."""
        return self._gap_habits.of(walker.id, walker.type)

    # --- giving back --------------------------------------------------------------------------

    def hand_back(
        self, name: str, x: float, y: float, edge: str, way: tuple[float, float] | None = None
    ) -> bool:
        """Give a held person back to SUMO, which lets it walk on to the same destination.

        Who would be moved by more than 1 m or turned round stays held, see return_places.py.

        Args:
            name: Id of the person.
            x: Coordinate x of its position [m].
            y: Coordinate y of its position [m].
            edge: Nearest edge for pedestrians. The person goes on along its route if that is near
                enough, else on a new route from this edge on.
            way: Displacement x, y [m] to where it is going now. Who would turn round in SUMO stays
                held. By default nothing is known.

        Returns:
            False if the person stays held.
        """
        if not (math.isfinite(x) and math.isfinite(y)) or edge.startswith(":"):
            return False  # SUMO can crash where it puts people into junctions
        route, person = self._routes[name], self._sumo.person
        if self.records and person.getLaneID(name).startswith(":"):
            route = replace(route, was_inside=True)
        try:
            place = self._places.find(name, route, (x, y), edge, way)
            if place is None:
                return False
            if place.step is None:
                self._handover.walk_anew(name, route, place.edges, place.foot)
            else:
                self._handover.walk_on(name, route, place.step, place.foot)
            if self._places.is_before_gap(name, place, person.getNextEdge(name)):
                self._handover.park(name, place.foot.lane)
                return False
        except self._handover.refusals:
            with contextlib.suppress(*self._handover.refusals):
                self._handover.park(name, person.getLaneID(name))
            return False
        self._release(name, "handed_back")
        self._free[name] = None
        self._put_back.add(name)
        return True

    def arrive(self, name: str) -> Arrival:
        """Let a held person end its walk in SUMO's next step.

        The person is put on the very end of its route, so that SUMO makes it arrive or go on with
        what follows: a stop, a ride or another walk, during which it can be taken over again.
        """
        route = self._routes[name]
        end = self._paths.lane(route.edges[-1])
        # if this fails, the walk is ended after the step
        with contextlib.suppress(*self._handover.refusals):
            self._handover.finish(name, end or "", route)
        self._leaving[name] = route.stages_left, self._sumo.person.getStage(name).depart
        arrival = Arrival.CONTINUED if route.stages_left else Arrival.ARRIVED
        self._release(name, arrival.value)
        return arrival

    def _release(self, name: str, as_what: str) -> None:
        self.held.discard(name)
        self.records.end(name)
        self._places.forget(name)
        del self._routes[name]
        self.counts[as_what] += 1
