"""People who wait at a light that rests, since SUMO does not know of them, make it go on."""

from collections.abc import Sequence

import numpy as np

from giveway.sumo.light_requests import LightRequests
from giveway.walkways.reading import Signal
from pedestrian_model import Crowd, Surroundings

_HERE = 2.0  # distance [m] to the kerb within which people wait
_MORE = 1.0  # time [s] beyond a phase's longest time, after which its light rests


class Requests:
    """Watches the lights whose phases depend on requests.

    Args:
        lights: Requests to SUMO's lights.
        signals: Signals of crossings, in the order of ``Surroundings.closed``.
    """

    def __init__(self, lights: LightRequests, signals: Sequence[Signal]) -> None:
        self._lights = lights
        systems = dict.fromkeys(signal.tls for signal in signals)
        self._answering = set(lights.answering(tuple(systems)))
        self._systems = [signal.tls for signal in signals]
        self._since: dict[str, tuple[str, float]] = {}  # state of each light, and time [s] of it

    def __bool__(self) -> bool:
        return bool(self._answering)

    def update(
        self, states: dict[str, str], time: float, crowd: Crowd, surroundings: Surroundings
    ) -> None:
        """Let lights go on at which people wait while nothing changes.

        Args:
            states: Present state of each light.
            time: SUMO's clock [s].
            crowd: All pedestrians.
            surroundings: Signals that are closed.
        """
        for system in self._answering:
            state, since = self._since.get(system, ("", time))
            if states.get(system, "") != state:
                self._since[system] = states.get(system, ""), time
            elif time - since > self._lights.longest(system) + _MORE and self._waits(
                system, crowd, surroundings
            ):
                self._lights.go_on(system)

    def _waits(self, system: str, crowd: Crowd, surroundings: Surroundings) -> bool:
        """Return whether somebody waits for a light."""
        at = crowd.waypoint_start[:-1] + crowd.waypoint_index
        signal = crowd.waypoint_signal[at]
        way = crowd.waypoints[at] - crowd.position
        there = (signal >= 0) & (np.hypot(way[:, 0], way[:, 1]) <= _HERE)
        return any(
            number < len(self._systems)
            and self._systems[number] == system
            and surroundings.closed[number]
            for number in signal[there].tolist()
        )
