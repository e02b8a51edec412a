"""Requests for green at traffic lights that SUMO does not hear of."""

from collections.abc import Sequence
from typing import Any

_STATIC = 0  # SUMO's number of the type of lights with fixed times
_LONGEST = 60.0  # time [s] after which a phase without a longest time goes on


class LightRequests:
    """Lets lights that rest in a phase go on to the next one.

    Args:
        sumo: The libsumo module, with a simulation running.
    """

    def __init__(self, sumo: Any) -> None:
        self._lights = sumo.trafficlight

    def answering(self, systems: Sequence[str]) -> tuple[str, ...]:
        """Return those of the lights whose phases depend on requests."""
        return tuple(name for name in systems if self._program(name).type != _STATIC)

    def longest(self, system: str) -> float:
        """Return the longest time [s] of a light's present phase."""
        phases = self._program(system).phases
        number = int(self._lights.getPhase(system))
        longest = float(phases[number].maxDur) if number < len(phases) else 0.0
        return longest if longest > 0.0 else _LONGEST

    def go_on(self, system: str) -> None:
        """End a light's present phase."""
        phases = self._program(system).phases
        number = int(self._lights.getPhase(system))
        if number < len(phases):
            others = [int(after) for after in phases[number].next if after != number]
            self._lights.setPhase(system, others[0] if others else (number + 1) % len(phases))

    def _program(self, system: str) -> Any:
        running = self._lights.getProgram(system)
        logics = self._lights.getAllProgramLogics(system)
        return next((one for one in logics if one.programID == running), logics[0])
