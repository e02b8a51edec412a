"""What the vehicle in this process and the isolated one share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import isfinite
from typing import TYPE_CHECKING, Self

from fmus.errors import FmuStateError, FmuStepError

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType


class SteppedVehicle(ABC):
    """A vehicle's state as plain numbers, and the refusal of calls that come at a wrong time.

    Args:
        path: of the FMU.

    Attributes:
        position: [m] as of the last step.
        speed: [m/s] as of the last step.
        acceleration: [m/s2] as of the last step.
        time: [s] the number of steps times the step size, never a running sum.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.position = self.speed = self.acceleration = self.time = 0.0
        self._failed = False  # at the last start or step
        self._refusal = ""
        self._refuse("has not been started; call start() first")

    @abstractmethod
    def close(self) -> None:
        """Free everything; nothing happens the second time."""

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
            msg = f"{self.path}: force {force} N at {self.time:.10g} s; expected a finite number"
            raise FmuStepError(msg)

    def _refuse(self, reason: str) -> None:
        """Have all steps refused for this reason until the next start."""
        self._failed = False
        self._refusal = f"{self.path}: the vehicle {reason}"

    def _fail(self) -> None:
        """Have all steps refused because the last start or step has failed."""
        self._refuse(f"failed at {self.time:.10g} s; start it again")
        self._failed = True
