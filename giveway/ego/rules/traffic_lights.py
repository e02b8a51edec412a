"""The traffic lights on the ego's path: where it has to stop, if anywhere, and when to arrive.

An ego that knows when a light turns green approaches it slowly instead of stopping:
*green light optimal speed advisory* (GLOSA). The plans come by the messages of SAE J2735 and
ETSI TS 103 301.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from giveway.ego.rules.junctions import RED, YELLOW
from giveway.ego.rules.protocol import LIGHT, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import STOP_BEFORE, at_rest, needed_braking
from giveway.sumo.network.lane_path import Light
from giveway.sumo.signal_plans import Greens, GreensOf

_ARROW = frozenset("s")  # red with a green arrow: after a stop one may go
_SLOWED = 0.8  # share of the speed at which it decided to pass at yellow; slower, it stops
_SLOWEST = 2.0  # lowest advisory speed [m/s]
_FAR = 150.0  # distance [m] within which the ego receives a signal plan
_STARTS = 1.0  # start-up time [s] of the first vehicle after the light turns green
_COASTING = 0.4  # largest step [m/s] of the advisory speed below the present one: 1 m/s^2
_WAVE = 4.2  # [m/s] at which starting runs back along a queue, 15 km/h (Treiber & Kesting 2013)


class TrafficLights:
    """Watches the traffic lights on one ego's path.

    At yellow the ego stops if it can with the comfortable deceleration, and goes on if not, as
    long as nobody makes it brake; at red it stops if it can at all.

    Args:
        lights: Traffic lights in the order of the path.
        comfortable: Deceleration [m/s^2] that is demanded at yellow.
        hardest: Deceleration [m/s^2] that the vehicle is capable of.
        arrows: Whether right of way rules at a green arrow beside red; else that is red.
        greens_of: Green windows of a movement, or None if the ego is not told any.
        desired_speed: Speed [m/s] of a free ego by its station [m].
        gap: Distance [m] kept to a vehicle ahead.

    Attributes:
        needs: The signal systems on the path.
    """

    def __init__(
        self,
        lights: Sequence[Light],
        *,
        comfortable: float,
        hardest: float,
        arrows: bool = False,
        greens_of: GreensOf | None = None,
        desired_speed: Callable[[float], float] = lambda _: math.inf,
        gap: float = 0.0,
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
        self._desired_speed = desired_speed
        self._gap = gap
        self.needs = Needs(frozenset(light.system for light in self._lights))

    @classmethod
    def on(cls, route: RouteContext) -> TrafficLights | None:
        """The rule on one ego's route; None if there are no traffic lights, or it heeds none."""
        lights = route.lane_path.lights
        if not (lights and route.heeds("traffic_lights")):
            return None
        return cls(
            lights,
            comfortable=route.config.regulation.comfortable_deceleration,
            hardest=route.hardest_braking,
            arrows=route.heeds("right_of_way"),
            greens_of=route.session.signal_plans.greens if route.heeds("signal_advice") else None,
            desired_speed=route.desired_speed,
            gap=route.config.regulation.safe_distance,
        )

    def update(self, situation: Situation) -> None:
        """Take note of the lights' states.

        Args:
            situation: What the rules know now.
        """
        states, front, speed = situation.signals, situation.station, situation.speed
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

    def demand(self, situation: Situation) -> Demand | None:
        """A stop before a red light, and the speed at which the ego arrives at green.

        Args:
            situation: What the rules know now.
        """
        stop = self._stop_at(situation.station, situation.speed)
        advice = self._advised(situation) if self._greens else math.inf
        if stop == math.inf == advice:
            return None
        return Demand(stop, LIGHT, advice=advice)

    def _stop_at(self, front: float, speed: float) -> float:
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

    def _advised(self, situation: Situation) -> float:
        """The speed [m/s] at which the ego arrives when it may go on (GLOSA); inf: any speed."""
        if self._next >= len(self._lights):
            return math.inf
        front, speed = situation.station, situation.speed
        wanted = self._desired_speed(front)
        line = self._lights[self._next].station
        place, queue = line - STOP_BEFORE, 0.0  # [m], [s]
        if self._colours[self._next] in self._red:
            ahead = at_rest(situation.leader, place)
            if ahead.station < place:
                queue = _STARTS + (line - ahead.station) / _WAVE
                place = min(place, ahead.station - self._gap)
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
