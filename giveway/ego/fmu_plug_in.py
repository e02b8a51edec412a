"""A controller FMU as a plug-in: observations become its inputs, its output becomes a command."""

from collections.abc import Callable
from math import inf

from controller import Acceleration, Force, Observation, PlugInError, Speed
from fmus import FmuError, IsolatedController, PreparedController
from giveway.errors import retold

_TOLD: dict[str, Callable[[Observation], float]] = {
    "speed": lambda seen: seen.speed,
    "acceleration": lambda seen: seen.acceleration,
    "position": lambda seen: seen.position,
    "last_force": lambda seen: seen.force,
    "gap": lambda seen: seen.gap,
    "person_gap": lambda seen: seen.person_gap,
    "leader_gap": lambda seen: seen.leader_gap,
    "leader_speed": lambda seen: seen.leader_speed,
    "speed_limit": lambda seen: seen.speed_limit,
    "stop_gap": lambda seen: seen.stop_gap,
}


class FmuPlugIn:
    """A controller that asks an FMU, in a separate process that starts with the first question.

    Args:
        prepared: Controller FMU, examined and unpacked.
    """

    def __init__(self, prepared: PreparedController) -> None:
        wiring = prepared.wiring
        self.horizon = wiring.horizon
        self._fmu = IsolatedController(prepared)
        self._single = [_TOLD[wire.role] for wire in wiring.inputs if wire.role in _TOLD]
        roles = [wire.role for wire in wiring.inputs]
        self._positions = roles.count("obstacle_positions")
        self._gaps = roles.count("obstacle_gaps")
        self._answer = wiring.answer.role
        self._lead = 0.0
        if prepared.profile.outputs.speed is not None:
            self._lead = prepared.profile.outputs.speed.lead or 0.0

    @property
    def warnings(self) -> list[str]:
        """The warnings about the FMU, one sentence each."""
        return self._fmu.warnings

    def control(self, seen: Observation) -> Force | Acceleration | Speed:
        """Ask the FMU for its command.

        Raises:
            PlugInError: the FMU gives no command.
        """
        told = [tell(seen) for tell in self._single]
        if self.horizon:
            ahead = seen.obstacle_positions.tolist()
            ahead += (self.horizon - len(ahead)) * [inf]
            told += ahead[: self._positions]
            told += [station - seen.position for station in ahead[: self._gaps]]
        with retold(FmuError, PlugInError):
            value = self._fmu.ask(told)
        if self._answer == "force":
            return Force(value)
        if self._answer == "acceleration":
            return Acceleration(value)
        return Speed(value, self._lead)

    def reset(self) -> None:
        """Forget the past."""
        self._fmu.restart()

    def close(self) -> None:
        """End the FMU's process."""
        self._fmu.close()
