"""Right of way among vehicles: where the ego waits at a junction for vehicles that go first.

The network (states of its links, rows of ``request``) and the traffic light, if there is one, say
which vehicles have priority. `TrafficLights` handles red and yellow. With ``G`` the ego has
priority. With ``g``, ``s`` (after a stop), ``o`` and without a light it yields to the movements
that ``request`` names, unless their light is red. At an all-way stop the vehicle that has stood
longest goes first.

The ego waits for a vehicle with priority that it would obstruct by driving on. It goes first if the
vehicle arrives at least the critical headway (`gap_acceptance`) after the ego leaves its line, and
at least a second after the ego has cleared the conflict. It waits at the line, or inside the
junction where SUMO's vehicles wait. It does not enter a junction that it could not leave because of
a slow vehicle ahead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set

from controller.driving_constants import (
    COMFORTABLE,
    FIRM,
    PULL_AWAY,
    PULL_AWAY_BRISK,
    SAFE_TIME,
    SAFE_TIME_BEHIND,
    STANDING,
    STOPS_AT_YELLOW,
    UNHURRIED,
)
from giveway.ego.perception.leader import Leader
from giveway.ego.rules.gap_acceptance import travel_time
from giveway.ego.rules.junctions import (
    RED,
    SIGHT,
    YELLOW,
    Approach,
    PathJunction,
    Traffic,
    letter_of,
)
from giveway.ego.rules.protocol import YIELD, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import (
    CRAWLING,
    STOP_BEFORE,
    USUAL_SPEED,
    firm_stop,
    leaves_no_room,
    needed_braking,
)
from giveway.geometry.conflict import Conflict
from giveway.sumo.network.junction_links import Movement

_GOING = 0.3  # time margin [s] to a vehicle that passes after an ego that has decided to go
_STAYS = 3.0  # time [s] after which a vehicle that stands without need is assumed to stay
_BOXED_IN = 1.0  # time [s] after which this is assumed of a vehicle without room to go on
_CLOSE = 3.0  # gap [m] to a standing vehicle ahead, below which a vehicle has no room to go on
_BRIEFLY = 1.0  # time [s] whose driving distance is added to this gap for a moving vehicle
# Wait [s] at the line in which the accepted headway falls to the follow-up headway; own choice
_IMPATIENT = 30.0
_AT_LINE = 4.0  # distance [m] before the line, within which a vehicle stands at it
_DECIDED = 10.0  # distance [m] before the line, within which the ego keeps its decision to go
# Letters of movements that yield to no vehicle: priority, and zippers (see the rule Merging)
_NOBODY = frozenset("GZ")


class RightOfWay:
    """Watches the junctions on one ego's path.

    Args:
        junctions: Junctions in the order of the path.
        name: SUMO's id of the ego, which is part of the traffic.
        length: Length of the ego's body [m].
        gap: Distance [m] that it keeps behind a standing vehicle.
        fastest: Highest speed [m/s] of the ego.
        critical_headway: Critical headway [s], or None for the Highway Capacity Manual's.

    Attributes:
        needs: Needs of the rule: junctions, their signal systems, and keep-clear zones.
        beside: Names of vehicles whose lanes lead them past the ego's path at the next junctions.
    """

    def __init__(
        self,
        junctions: Sequence[PathJunction],
        *,
        name: str,
        length: float,
        gap: float,
        fastest: float,
        critical_headway: float | None = None,
    ) -> None:
        self._junctions = tuple(junctions)
        self._name = name
        self._length, self._room = length, length + gap
        self._fastest = fastest
        self._critical_headway = critical_headway
        self._next = 0
        self._followed = -math.inf  # time [s] at which the vehicle before it crossed the next line
        self._stop = math.inf
        self._going = False  # whether the ego has decided to go through the next junction
        self._halted = False  # whether the ego has halted at the next line
        self._stood = 0.0  # time [s] for which the ego has stood near the next line
        self._time = -math.inf
        self._staying: set[str] = set()  # ids of standing vehicles that are assumed to stay
        self._green: dict[tuple[str, int], float] = {}  # times [s] at which others' green began
        self.needs = Needs(
            frozenset(place.movement.system for place in junctions) - {""},
            self._junctions,
            keep_clear=tuple((place.entry, place.exit + length) for place in junctions),
        )
        self.beside: Set[str] = frozenset()

    @classmethod
    def on(cls, route: RouteContext) -> RightOfWay | None:
        """The rule on one ego's route, or None if it has no junctions or the rule is off."""
        if not (route.heeds("right_of_way") and route.junctions):
            return None
        return cls(
            route.junctions,
            name=route.config.ego_id,
            length=route.shape.length,
            gap=route.standing_gap,
            fastest=route.fastest,
            critical_headway=route.config.regulation.critical_gap,
        )

    def _pass(self, front: float) -> None:
        """Forget the junctions that the ego has left."""
        while self._next < len(self._junctions) and self._junctions[self._next].exit < front:
            self._next += 1
            self._stop = math.inf  # the stop belonged to the junction that was passed
            self._going = self._halted = False
            self._stood, self._followed = 0.0, -math.inf

    def update(self, situation: Situation) -> None:
        """Decide where to wait.

        Args:
            situation: Present situation of the ego.
        """
        time, front, speed = situation.time, situation.station, situation.speed
        states, traffic = situation.signals, situation.traffic
        self._pass(front)
        ahead = self._junctions[self._next :]
        if not ahead or ahead[0].entry - front > SIGHT:
            self.beside = frozenset()
        if not (states or traffic):
            return  # without signals and traffic the decision stays as it is
        passed, self._time = time - self._time, time
        before, self._stop = self._stop, math.inf
        beside, others = set[str](), set[str]()
        for number in range(self._next, len(self._junctions)):
            place = self._junctions[number]
            if place.entry - front > SIGHT:
                break
            first = number == self._next
            for other in traffic.get(place.movement.junction, ()):
                (beside if other.number in place.beside else others).add(other.name)
            letter = letter_of(place.movement, states)
            if first:
                self._note(place, front, speed, passed, traffic)
            stop = self._stop_in(place, letter, first, front, speed, states, traffic)
            if first:
                near = place.line(front) - front <= _DECIDED
                self._going = stop == math.inf and (self._going or near) and letter not in RED
            needed = needed_braking(speed, stop + STOP_BEFORE - front)
            if stop < math.inf and (needed <= FIRM or abs(stop - before) <= STOP_BEFORE):
                self._stop = min(self._stop, max(stop, min(front, stop + STOP_BEFORE)))
        self.beside = beside - others

    def demand(self, situation: Situation) -> Demand | None:
        """The stop before or inside a junction at which the ego waits for others.

        Args:
            situation: Present situation of the ego.
        """
        stop = self._stop_at(situation.station, situation.speed, situation.leader_at_rest())
        return None if stop == math.inf else Demand(stop, YIELD)

    def _stop_at(self, front: float, speed: float, leader: Leader) -> float:
        """The station [m] at which the front bumper has to stop; inf if it need not stop."""
        stop = self._stop
        for place in self._junctions[self._next :]:
            if place.entry < front:
                continue
            line = place.line(front)
            blocked = leaves_no_room(leader, place.entry, place.exit, self._room)
            if blocked and needed_braking(speed, line - front) <= FIRM:
                stop = min(stop, max(line - STOP_BEFORE, min(firm_stop(front, speed), line)))
            break
        return stop

    def _note(
        self, place: PathJunction, front: float, speed: float, passed: float, traffic: Traffic
    ) -> None:
        """Note how long the ego stands at the line, and when a vehicle of its lane crosses it."""
        stands = place.line(front) - front <= _AT_LINE and speed < STANDING
        self._stood = self._stood + passed if stands and passed < math.inf else 0.0
        self._halted = self._halted or (stands and front <= place.entry)
        own = place.movement
        for other in traffic.get(own.junction, ()):
            if other.name == self._name:
                continue
            if other.number == own.number and -passed * other.speed < other.distance <= 0.0:
                self._followed = self._time

    def _stop_in(
        self,
        place: PathJunction,
        letter: str,
        first: bool,
        front: float,
        speed: float,
        states: Mapping[str, str],
        traffic: Traffic,
    ) -> float:
        """Station [m] at which the ego waits for others at one junction; inf if it need not."""
        line = place.line(front) - STOP_BEFORE
        before = front <= place.entry
        if before and letter in "sw" and not (first and self._halted):
            return line
        critical, follow_up = place.gaps.at_lights if letter in "gGyY" else place.gaps.unsignalled
        if self._critical_headway is not None:
            critical = self._critical_headway
        if first and before and letter not in "GMyY" and self._time - self._followed < follow_up:
            return line
        margin = SAFE_TIME
        if first and critical > follow_up:
            critical -= (critical - follow_up) * min(1.0, self._stood / _IMPATIENT)
        if first and self._going:
            critical, margin = 0.0, _GOING
        stop, stay = math.inf, set[str]()
        for other in traffic.get(place.movement.junction, ()):
            where = None if other.name == self._name else place.conflicts.get(other.number)
            source = place.movements[other.number].source
            if where is None or front > where.enter or source in stay:
                continue
            if self._stays(place, other, states, traffic):
                stay.add(source)  # vehicles behind it on its lane stay, too
                continue
            if not self._goes_first(place, letter, other, where, states, traffic):
                continue
            if not self._meets(place, other, where, front, speed, critical, margin):
                continue
            inside = [w for w in place.waiting if front <= w and w <= where.enter]
            if inside:
                stop = min(stop, inside[-1] - STOP_BEFORE)
            elif before:
                stop = min(stop, line)
        return stop

    def _stays(
        self, place: PathJunction, other: Approach, states: Mapping[str, str], traffic: Traffic
    ) -> bool:
        """Return whether a vehicle is assumed to stay: it stands without need, or is boxed in."""
        if other.standing <= 0.0:
            self._staying.discard(other.name)
            return other.speed < CRAWLING and _is_boxed_in(place, other, traffic)
        movement = place.movements[other.number]
        stood = other.standing
        if movement.system:
            key = movement.system, movement.link
            if letter_of(movement, states) in RED:
                self._green.pop(key, None)
                return False
            stood = min(stood, self._time - self._green.setdefault(key, self._time))
        patient = stood > _STAYS and self._stood > _STAYS
        if patient or (stood > _BOXED_IN and _is_boxed_in(place, other, traffic)):
            self._staying.add(other.name)  # until it moves; the ego may go before it
        return other.name in self._staying

    def _goes_first(
        self,
        place: PathJunction,
        letter: str,
        other: Approach,
        where: Conflict,
        states: Mapping[str, str],
        traffic: Traffic,
    ) -> bool:
        """Return whether the ego has to let the vehicle go first, by priority alone."""
        movement = place.movements[other.number]
        named = other.number in place.movement.yields_to
        if other.distance <= 0.0:  # the vehicle is in the junction already
            if other.distance + where.other_leave + other.length <= 0.0:
                return False
            room = other.distance + where.other_enter
            if room > 0.0 and not named and place.movement.number in movement.yields_to:
                return needed_braking(other.speed, room) > COMFORTABLE  # else it gives way
            waits = other.standing > 0.0 and _has_to_wait(movement, traffic)
            return room <= 0.0 or other.speed > CRAWLING or (named and letter != "G" and not waits)
        if letter in _NOBODY or not named:
            return False
        if movement.system:
            its = letter_of(movement, states)
            if its in RED:
                return False
            needed = other.speed**2 / (2.0 * other.distance)
            return its not in YELLOW or needed > STOPS_AT_YELLOW
        if letter == "w":
            return other.distance < _AT_LINE and other.standing > self._stood
        return True

    def _meets(
        self,
        place: PathJunction,
        other: Approach,
        where: Conflict,
        front: float,
        speed: float,
        critical: float,
        margin: float,
    ) -> bool:
        """Return whether the ego would obstruct or meet the vehicle if it drove on."""
        fastest = max(self._fastest, speed)
        line, clear = (
            travel_time(station - front, speed, PULL_AWAY, fastest)
            for station in (place.entry, where.leave + self._length)
        )
        enter = travel_time(where.enter - front, speed, PULL_AWAY_BRISK, fastest)
        to_enter = other.distance + where.other_enter
        to_leave = other.distance + where.other_leave + other.length
        comes = travel_time(to_enter, other.speed, UNHURRIED, max(USUAL_SPEED, other.speed))
        goes = math.inf
        if other.speed >= STANDING:  # inside the junction it keeps its lanes' speed limit
            inside = min(other.speed, place.movements[other.number].speed)
            outside = min(max(other.distance, 0.0), to_leave)
            goes = outside / other.speed + (to_leave - outside) / inside
        in_time = comes >= max(clear + margin, line + critical if front <= place.entry else 0.0)
        return not in_time and goes + SAFE_TIME_BEHIND > enter


def _has_to_wait(movement: Movement, traffic: Traffic) -> bool:
    """Return whether a vehicle to which this movement yields is near. The ego counts, too."""
    return any(one.number in movement.yields_to for one in traffic.get(movement.junction, ()))


def _is_boxed_in(place: PathJunction, other: Approach, traffic: Traffic) -> bool:
    """Return whether a standing vehicle right ahead on its lane stops another one."""
    source = place.movements[other.number].source
    return any(
        ahead.standing > _BOXED_IN
        and ahead.distance < other.distance
        and other.distance - ahead.distance - ahead.length < _CLOSE + _BRIEFLY * other.speed
        and place.movements[ahead.number].source == source
        for ahead in traffic.get(place.movement.junction, ())
    )
