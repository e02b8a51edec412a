"""The traffic lights on the ego's path: the stop that they demand, and the advised speed.

An ego that knows when a light turns green approaches it slowly instead of stopping:
*green light optimal speed advisory* (GLOSA). The signal plans come with the messages of SAE J2735
and ETSI TS 103 301.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from controller.driving_constants import COMFORTABLE
from giveway.ego.rules.junctions import RED, YELLOW
from giveway.ego.rules.protocol import LIGHT, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import STOP_BEFORE, at_rest, needed_braking
from giveway.sumo.network.lane_path import Light
from giveway.sumo.signal_plans import Greens, GreensOf

_ARROW = frozenset("s")  # letter of red with a green arrow: a turn is allowed after a stop
_SLOWED = 0.8  # share of the speed at the decision to pass at yellow, below which the ego stops
_LASTS = 3.0  # shortest time [s] of yellow at 50 km/h (RiLSA 2015; netconvert's default)
_SLOWEST = 5.0  # lowest advisory speed [m/s], as of SUMO's device.glosa.min-speed
_KEPT_UP = 4.0  # pace [m/s] below which advice that was begun ends
_FAR = 150.0  # distance [m] within which the ego receives a signal plan
_STARTS = 1.0  # start-up time [s] of the first vehicle after the light turns green
_COASTING = 0.4  # largest drop [m/s] of the advisory speed below the present one (1 m/s^2)
FOLLOWED = 50.0  # distance [m] of a vehicle behind, within which nothing is advised
_WAVE = 4.2  # speed [m/s] of the start-up wave in a queue, 15 km/h (Treiber & Kesting 2013)


class TrafficLights:
    """Watches the traffic lights on one ego's path.

    At yellow the ego stops if the comfortable deceleration is enough. If it is not, the ego goes
    on, unless a road user makes it slow down. At red it stops if it can at all.

    Args:
        lights: Traffic lights in the order of the path.
        comfortable: Deceleration [m/s^2] that is demanded at yellow.
        hardest: Deceleration [m/s^2] that the vehicle is capable of.
        arrows: Whether a green arrow beside red is left to the rule of right of way. If not, it
            counts as red.
        greens_of: Function that returns the green windows of a movement, or None if the ego
            receives no signal plans.
        desired_speed: Function that returns the free speed [m/s] at a station [m].
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
        self._began = [-math.inf] * len(lights)  # times [s] at which yellow began
        self._passing = [0.0] * len(lights)  # speeds [m/s] at decisions to pass; 0 without one
        self._red = RED if arrows else RED | _ARROW
        self._next = 0
        self._greens_of = greens_of
        self._greens: Greens = ()  # green windows of the next light
        self._advises = False  # whether it follows the advice for the next light
        self._desired_speed = desired_speed
        self._gap = gap
        self.needs = Needs(frozenset(light.system for light in self._lights))

    @classmethod
    def on(cls, route: RouteContext) -> TrafficLights | None:
        """The rule on one ego's route, or None if it has no traffic lights or the rule is off."""
        lights = route.lane_path.lights
        if not (lights and route.heeds("traffic_lights")):
            return None
        return cls(
            lights,
            comfortable=COMFORTABLE,
            hardest=route.hardest_braking,
            arrows=route.heeds("right_of_way"),
            greens_of=route.session.signal_plans.greens if route.heeds("signal_advice") else None,
            desired_speed=route.desired_speed,
            gap=route.config.regulation.safe_distance,
        )

    def update(self, situation: Situation) -> None:
        """Take note of the lights' states.

        Args:
            situation: Present situation of the ego.
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
                self._began[i] = situation.time
            elif (
                speed < _SLOWED * self._passing[i]
                and needed <= self._hardest
                and light.station - front
                > _SLOWED * speed * (self._began[i] + _LASTS - situation.time)
            ):
                # An ego that was slowed down, and may be slowed further, would pass too late.
                self._passing[i] = 0.0
            self._colours[i] = colour
        self._greens = ()
        if self._greens_of is not None and self._next < len(self._lights):
            light = self._lights[self._next]
            if front < light.station < front + _FAR:
                self._greens = self._greens_of(light.system, light.link)

    def demand(self, situation: Situation) -> Demand | None:
        """A stop before a red light, and the speed at which the ego arrives at green.

        Args:
            situation: Present situation of the ego.
        """
        stop = self._stop_at(situation.station, situation.speed)
        advice = self._advised(situation) if self._greens else math.inf
        if stop == math.inf == advice:
            return None
        return Demand(stop, LIGHT, advice=advice)

    def _stop_at(self, front: float, speed: float) -> float:
        """The station [m] at which the front bumper has to stop; inf if it need not stop."""
        while self._next < len(self._lights) and self._lights[self._next].station <= front:
            self._next += 1
            self._greens, self._advises = (), False  # they belonged to the light that was passed
        for i in range(self._next, len(self._lights)):
            colour = self._colours[i]
            stops = colour in self._red or (colour in YELLOW and self._passing[i] == 0.0)
            if stops and self._needed(i, front, speed) <= self._hardest:
                return self._lights[i].station - STOP_BEFORE
        return math.inf

    def _advised(self, situation: Situation) -> float:
        """The speed [m/s] at which the ego arrives at green (GLOSA), or inf without advice.

        There is no advice below `_SLOWEST`, none that would slow a vehicle close behind, and none
        to arrive in a queue that has not left before the light turns red again.
        """
        if self._next >= len(self._lights) or situation.follower_gap < FOLLOWED:
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
            if there >= end:
                continue
            arrival = begin + max(queue, _STARTS)
            if there >= begin + queue or arrival >= end:
                break
            pace = (place - front) / arrival
            # Slowing down costs a little of the pace, which does not end the advice.
            self._advises = pace >= (_KEPT_UP if self._advises else _SLOWEST)
            return max(pace, _SLOWEST, speed - _COASTING) if self._advises else math.inf
        return math.inf

    def _needed(self, i: int, front: float, speed: float) -> float:
        """Deceleration [m/s^2] with which the ego stops at the line of light ``i``."""
        return needed_braking(speed, self._lights[i].station - front)
