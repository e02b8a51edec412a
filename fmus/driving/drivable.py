"""What bringing a vehicle to its first state needs of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from fmus.interfaces.vehicle import Vehicle

if TYPE_CHECKING:
    from fmus.profile.preparation import Prepared


class Drivable(Vehicle, Protocol):
    """A vehicle whose FMU has been prepared and whose steps can be counted.

    Attributes:
        prepared: its FMU, with the wiring of the profile.
    """

    prepared: Prepared

    @property
    def between_steps(self) -> bool:
        """Not within a step of the FMU that is longer than the controller's."""
