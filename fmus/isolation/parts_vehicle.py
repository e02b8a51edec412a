"""A vehicle of several FMUs: driven like one FMU, with each part in a process of its own."""

import os
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

from fmus.description.model import Value
from fmus.driving.vehicle import VehicleFmu
from fmus.errors import FmuError
from fmus.isolation.parts import Parts
from fmus.profile.preparation import Prepared, prepare
from fmus.profile.vehicle_profile import VehicleProfile


class PartsVehicle(VehicleFmu):
    """A vehicle of several FMUs (``.ssp``), with the interface of :class:`fmus.VehicleFmu`.

    A crash, hang or fault of a part ends the episode with an error that names the part.

    Args:
        path: Path of the .ssp file.
        step_size: Step size of the controller [s].
        profile: Roles of the vehicle's variables, or None as for ``VehicleFmu``.
        start_values: Further start values by variable name.

    Raises:
        FmuError: as for ``VehicleFmu``, or a part cannot be used.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        step_size: float,
        profile: VehicleProfile | None = None,
        start_values: Mapping[str, Value] | None = None,
    ) -> None:
        prepared = prepare(path, step_size=step_size, profile=profile, start_values=start_values)
        with ExitStack() as stack:
            self._set_up(prepared, Path(), stack)

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
