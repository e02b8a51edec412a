"""The interface of every vehicle. It does not depend on the process of its FMU."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Self

from fmus.errors import FmuStateError, FmuStepError
from fmus.profile.preparation import Prepared
from fmus.profile.wiring import Recorded


class Vehicle(ABC):
    """A vehicle that giveway drives, in this process or in one of its own.

    Args:
        path: Path of the FMU.

    Attributes:
        position: Position [m] as of the last step.
        speed: Speed [m/s] as of the last step.
        acceleration: Acceleration [m/s2] as of the last step.
        time: Time [s]: the number of steps times the step size, never a running sum.
        step_size: Step size of the controller [s].
        knows_grades: True if it has an input for the road's grade.
        record: Variables that the profile lists for recording.
        recorded: Values of the profile's ``record`` after the last step, in the FMU's own units.
        warnings: Warnings for the user since the last start.
    """

    step_size: float
    warnings: list[str]
    knows_grades = False

    def __init__(self, path: Path) -> None:
        self.path = path
        self.position = self.speed = self.acceleration = self.time = 0.0
        self.record: tuple[Recorded, ...] = ()
        self.recorded: Sequence[float] = ()
        self._refusal = ""  # why no step can be done; empty while the vehicle is running
        self._refuse("has not been started; call start() first")

    @abstractmethod
    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0, at a position [m] and a speed [m/s]."""

    @abstractmethod
    def step(self, force: float, grade: float = 0.0) -> None:
        """Hold ``force`` [N] for one step on a ``grade`` [rad], and set the attributes.

        A grade is uphill if it is positive; an FMU without an input for it drives as on the level.
        """

    @abstractmethod
    def close(self) -> None:
        """Free everything; a second call does nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _require_step(self, force: float) -> None:
        """Refuse a step that cannot be done.

        Raises:
            FmuStateError: the vehicle is not running.
            FmuStepError: the force is not a finite number.
        """
        if self._refusal:
            raise FmuStateError(self._refusal)
        if not isfinite(force):
            raise FmuStepError(
                f"{self.path}: force {force} N at {self.time:.10g} s; expected a finite number"
            )

    def _refuse(self, reason: str) -> None:
        """Let all steps be refused for this reason until the next start."""
        self._refusal = f"{self.path}: the vehicle {reason}"

    def _fail(self) -> None:
        """Let all steps be refused because the last start or step has failed."""
        self._refuse(f"failed at {self.time:.10g} s; start it again")


class Drivable(Vehicle):
    """A vehicle whose FMU has been prepared and whose steps can be counted.

    Attributes:
        prepared: FMU of the vehicle, with the wiring of the profile.
    """

    prepared: Prepared

    @property
    @abstractmethod
    def between_steps(self) -> bool:
        """True if an FMU step has ended within the last control step."""
