"""The plans of traffic lights: their next states and times, as connected vehicles receive them.

SAE J2735 calls it *signal phase and timing* (SPaT). ISO/TS 19091 describes its use.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple


class SignalChange(NamedTuple):
    """The next change of a traffic light."""

    time: float  # [s] time until then; an actuated light may extend its phase
    state: str  # state after the change, one letter per movement


ChangeOf = Callable[[str], SignalChange | None]
"""Function that returns the next change of a traffic light by its id, or None if it is unknown."""


class _Phase(NamedTuple):
    """A phase of a signal program."""

    state: str
    follows: int  # number of the next phase, or -1 if there is none or it is not certain


def untold(_: str) -> SignalChange | None:
    """Return None: the next signal change is unknown for every traffic light."""
    return None


class SignalPlans:
    """The plans of a running simulation's traffic lights. Each is read when it is first needed.

    Args:
        sumo: The libsumo module, with a loaded simulation.
    """

    def __init__(self, sumo: Any) -> None:
        self._sumo = sumo
        self._plan = cache(self._read)

    def change(self, system: str) -> SignalChange | None:
        """Return the next change of a light, or None if it is unknown.

        Args:
            system: SUMO's id of the traffic light.
        """
        plan, phase = self._now(system)
        if phase < 0 or plan[phase].follows < 0:
            return None
        return SignalChange(self._left(system), plan[plan[phase].follows].state)

    def _now(self, system: str) -> tuple[tuple[_Phase, ...], int]:
        """Return the running program and the number of its phase, or -1 if the phase is unknown."""
        lights = self._sumo.trafficlight
        program = str(lights.getProgram(system))
        plan = self._plan(system, program)
        phase = int(lights.getPhase(system))
        return plan, phase if phase < len(plan) else -1

    def _left(self, system: str) -> float:
        """Return the time [s] until the present phase ends."""
        switches = float(self._sumo.trafficlight.getNextSwitch(system))
        return max(switches - float(self._sumo.simulation.getTime()), 0.0)

    def _read(self, system: str, program: str) -> tuple[_Phase, ...]:
        """Read the phases of a program."""
        for logic in self._sumo.trafficlight.getAllProgramLogics(system):
            if str(logic.programID) == program:
                phases = logic.phases
                return tuple(
                    _Phase(
                        str(phase.state),
                        _only(list(phase.next) or [(number + 1) % len(phases)], len(phases)),
                    )
                    for number, phase in enumerate(phases)
                )
        return ()


def _only(follows: list[int], count: int) -> int:
    """Return the only phase of ``count`` phases that may follow, or -1 if it is not certain."""
    return int(follows[0]) if len(follows) == 1 and 0 <= follows[0] < count else -1
