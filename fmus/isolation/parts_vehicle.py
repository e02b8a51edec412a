"""A vehicle of several FMUs: driven like one FMU, with each part in a process of its own."""

from contextlib import ExitStack
from pathlib import Path

from fmus.driving.vehicle import VehicleFmu
from fmus.errors import FmuError
from fmus.isolation.parts import Parts
from fmus.profile.preparation import Prepared


class PartsVehicle(VehicleFmu):
    """A vehicle of several FMUs (``.ssp``), with the interface of :class:`fmus.VehicleFmu`.

    A crash, hang or fault of a part ends the episode with an error that names the part.
    """

    def _place(self, prepared: Prepared, stack: ExitStack) -> Path:  # noqa: ARG002 - as below
        return Path()

    def _load(self, prepared: Prepared, folder: Path) -> Parts:  # noqa: ARG002 - each part has its own
        self._parts = Parts(prepared)
        return self._parts

    def start(self, *, position: float = 0.0, speed: float = 0.0) -> None:
        """Begin (again) at time 0 with new processes; see :class:`fmus.VehicleFmu`."""
        super().start(position=position, speed=speed)
        self._take_warnings()

    def step(self, force: float, grade: float = 0.0) -> None:
        """Hold ``force`` [N] for one step; see :class:`fmus.VehicleFmu`."""
        try:
            super().step(force, grade)
        except FmuError:
            self._fail()
            raise
        finally:
            self._take_warnings()

    def _take_warnings(self) -> None:
        if self._parts.warnings:
            self.warnings += self._parts.warnings
            self._parts.warnings.clear()
