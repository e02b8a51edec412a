"""What a traffic light shows next, and when: its plan, as a signal tells it to a connected vehicle.

SAE J2735 calls it *signal phase and timing* (SPaT), ISO/TS 19091 says what it is for.
"""

from collections.abc import Callable
from typing import Any, NamedTuple


class SignalChange(NamedTuple):
    """The next change of a traffic light."""

    time: float  # [s] until then; an actuated light may go on for longer
    state: str  # from then on, one letter per movement


ChangeOf = Callable[[str], SignalChange | None]
"""The next change of a traffic light by its id; None: nobody can tell."""


def untold(_: str) -> SignalChange | None:
    """Of no light anybody can tell what comes."""
    return None


class SignalPlans:
    """The plans of a running simulation's traffic lights, each read when it is first asked for.

    Args:
        sumo: the libsumo module, with a loaded simulation.
    """

    def __init__(self, sumo: Any) -> None:
        self._sumo = sumo
        self._plans: dict[tuple[str, str], tuple[str | None, ...]] = {}

    def change(self, system: str) -> SignalChange | None:
        """The next change; None: nobody can tell what comes.

        Args:
            system: SUMO's id of the traffic light.
        """
        lights = self._sumo.trafficlight
        program = str(lights.getProgram(system))
        plan = self._plans.get((system, program))
        if plan is None:
            plan = self._plans[system, program] = self._read(system, program)
        phase = int(lights.getPhase(system))
        state = plan[phase] if 0 <= phase < len(plan) else None
        if state is None:
            return None
        left = float(lights.getNextSwitch(system)) - float(self._sumo.simulation.getTime())
        return SignalChange(max(left, 0.0), state)

    def _read(self, system: str, program: str) -> tuple[str | None, ...]:
        """What follows each phase; None where several may."""
        for logic in self._sumo.trafficlight.getAllProgramLogics(system):
            if str(logic.programID) == program:
                phases = logic.phases
                follows = [
                    list(phase.next) or [(number + 1) % len(phases)]
                    for number, phase in enumerate(phases)
                ]
                return tuple(
                    str(phases[after[0]].state)
                    if len(after) == 1 and 0 <= after[0] < len(phases)
                    else None
                    for after in follows
                )
        return ()
