"""What any vehicle offers, wherever its FMU runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType


class Vehicle(Protocol):
    """What giveway drives, in this process or in one of its own.

    Attributes:
        path: of the FMU.
        position: [m] as of the last step.
        speed: [m/s] as of the last step.
        acceleration: [m/s2] as of the last step.
        time: [s] k times the step size, never a running sum.
    """

    path: Path
    position: float
    speed: float
    acceleration: float
    time: float

    @property
    def step_size(self) -> float:
        """[s]."""

    @property
    def warnings(self) -> list[str]:
        """What the user should know of this FMU."""

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0, at a position [m] and a speed [m/s]."""

    def step(self, force: float) -> None:
        """Hold ``force`` [N] for one step."""

    def close(self) -> None:
        """Free everything."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
