"""The traffic lights on the ego's path: where it has to stop, if anywhere, and when to arrive.

Who knows when a light turns green need not hurry to stand before it: *green light optimal speed
advisory* (GLOSA; the plans come by the messages of SAE J2735 and ETSI TS 103 301).
"""

import math
from collections.abc import Mapping, Sequence

from giveway.ego.giving_way import STOP_BEFORE, at_rest, needed_braking
from giveway.ego.perception.leader import Leader
from giveway.sumo.lane_path import Light
from giveway.sumo.signal_plans import Greens, GreensOf

RED = frozenset("rRu")  # red, red with yellow
_ARROW = frozenset("s")  # red with a green arrow: after a stop one may go
YELLOW = frozenset("yY")
_SLOWED = 0.8  # of the speed at which it goes on at yellow; slower, it stops if it can at all
_SLOWEST = 2.0  # [m/s] that nobody is slowed below for a light that is red for long yet
_FAR = 150.0  # [m] from where on it listens to a light
_STARTS = 1.0  # [s] after the light has turned green the first vehicle starts
_COASTING = 0.4  # [m/s] that the speed is lowered at once: 1 m/s^2 of slowing
_WAVE = 4.2  # [m/s] at which starting runs back along a queue, 15 km/h (Treiber & Kesting 2013)


class Lights:
    """Watches the lights on one ego's path.

    At yellow the ego stops if it can with the comfortable deceleration, and goes on if not, as
    long as nobody makes it brake; at red it stops if it can at all.

    Args:
        lights: in the order of the path.
        comfortable: deceleration [m/s^2] that is demanded at yellow.
        hardest: deceleration [m/s^2] that the vehicle is capable of.
        arrows: at a green arrow beside red somebody else stops and gives way; else it is red.
        greens_of: when a movement is green; None: that is not asked for.

    Attributes:
        systems: SUMO's ids of the traffic lights on the path.
    """

    def __init__(
        self,
        lights: Sequence[Light],
        *,
        comfortable: float,
        hardest: float,
        arrows: bool = False,
        greens_of: GreensOf | None = None,
    ) -> None:
        self._lights = tuple(lights)
        self._comfortable = comfortable
        self._hardest = hardest
        self._colours = ["g"] * len(lights)
        self._passing = [0.0] * len(lights)  # [m/s] when that was decided at yellow; 0: it was not
        self._red = RED if arrows else RED | _ARROW
        self._next = 0
        self._greens_of = greens_of
        self._greens: Greens = ()  # of the next one
        self.systems = frozenset(light.system for light in self._lights)

    def update(self, states: Mapping[str, str], front: float, speed: float) -> None:
        """Take note of the lights' states.

        Args:
            states: of each system, one letter per movement (SUMO's).
            front: station of the front bumper [m].
            speed: [m/s].
        """
        for i in range(self._next, len(self._lights)):
            light = self._lights[i]
            state = states.get(light.system, "")
            colour = state[light.link] if light.link < len(state) else "O"
            needed = self._needed(i, front, speed)
            if colour not in YELLOW:
                self._passing[i] = 0.0
            elif self._colours[i] not in YELLOW:
                self._passing[i] = speed if needed > self._comfortable else 0.0
            elif speed < _SLOWED * self._passing[i] and needed <= self._hardest:
                self._passing[i] = 0.0  # who had to brake for somebody comes too late
            self._colours[i] = colour
        self._greens = ()
        if self._greens_of is not None and self._next < len(self._lights):
            light = self._lights[self._next]
            if front < light.station < front + _FAR:
                self._greens = self._greens_of(light.system, light.link)

    def stop_at(self, front: float, speed: float) -> float:
        """Station [m] at which the front bumper has to stop; inf: nowhere."""
        while self._next < len(self._lights) and self._lights[self._next].station <= front:
            self._next += 1
            self._greens = ()  # they were the passed one's
        for i in range(self._next, len(self._lights)):
            colour = self._colours[i]
            stops = colour in self._red or (colour in YELLOW and self._passing[i] == 0.0)
            if stops and self._needed(i, front, speed) <= self._hardest:
                return self._lights[i].station - STOP_BEFORE
        return math.inf

    def unhurried(
        self, front: float, speed: float, wanted: float, leader: Leader, gap: float
    ) -> float:
        """The speed [m/s] at which it arrives when it may go on; inf: nothing speaks for less.

        Args:
            front: station of the front bumper [m].
            speed: now [m/s].
            wanted: speed [m/s] of a free ego.
            leader: the vehicle ahead.
            gap: [m] that is kept to it.
        """
        if not self._greens or self._next >= len(self._lights):
            return math.inf
        line = self._lights[self._next].station
        place, queue = line - STOP_BEFORE, 0.0  # [m], [s]
        if self._colours[self._next] in self._red:
            ahead = at_rest(leader, place)
            if ahead.station < place:
                queue = _STARTS + (line - ahead.station) / _WAVE
                place = min(place, ahead.station - gap)
        there = (place - front) / wanted
        for begin, end in self._greens:
            if there < begin + queue:
                pace = (place - front) / (begin + max(queue, _STARTS))
                return max(pace, _SLOWEST, speed - _COASTING)
            if there < end:
                break
        return math.inf

    def _needed(self, i: int, front: float, speed: float) -> float:
        """Deceleration [m/s^2] that stops at the line itself."""
        return needed_braking(speed, self._lights[i].station - front)
