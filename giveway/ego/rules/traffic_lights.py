"""The traffic lights on the ego's path, and the stop that they demand."""

from __future__ import annotations

import math
from collections.abc import Sequence

from controller.driving_constants import COMFORTABLE
from giveway.ego.rules.junctions import RED, YELLOW
from giveway.ego.rules.protocol import LIGHT, Demand, Needs, Situation
from giveway.ego.rules.route import RouteContext
from giveway.ego.rules.yielding import STOP_BEFORE, needed_braking
from giveway.sumo.network.lane_path import Light

_ARROW = frozenset("s")  # letter of red with a green arrow: a turn is allowed after a stop
_SLOWED = 0.8  # share of the speed at the decision to pass at yellow, below which the ego stops
_LASTS = 3.0  # shortest time [s] of yellow at 50 km/h (RiLSA 2015; netconvert's default)


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
    ) -> None:
        self._lights = tuple(lights)
        self._comfortable = comfortable
        self._hardest = hardest
        self._colours = ["g"] * len(lights)
        self._began = [-math.inf] * len(lights)  # times [s] at which yellow began
        self._passing = [0.0] * len(lights)  # speeds [m/s] at decisions to pass; 0 without one
        self._red = RED if arrows else RED | _ARROW
        self._next = 0
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

    def demand(self, situation: Situation) -> Demand | None:
        """A stop before a red light, or None if the ego need not stop.

        Args:
            situation: Present situation of the ego.
        """
        stop = self._stop_at(situation.station, situation.speed)
        return Demand(stop, LIGHT) if stop < math.inf else None

    def _stop_at(self, front: float, speed: float) -> float:
        """The station [m] at which the front bumper has to stop; inf if it need not stop."""
        while self._next < len(self._lights) and self._lights[self._next].station <= front:
            self._next += 1
        for i in range(self._next, len(self._lights)):
            colour = self._colours[i]
            stops = colour in self._red or (colour in YELLOW and self._passing[i] == 0.0)
            if stops and self._needed(i, front, speed) <= self._hardest:
                return self._lights[i].station - STOP_BEFORE
        return math.inf

    def _needed(self, i: int, front: float, speed: float) -> float:
        """Deceleration [m/s^2] with which the ego stops at the line of light ``i``."""
        return needed_braking(speed, self._lights[i].station - front)
