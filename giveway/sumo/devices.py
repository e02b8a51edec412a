"""The devices of SUMO's vehicles that change their routes."""

import contextlib
from typing import Any


class Devices:
    """Reads and switches the devices of vehicles.

    Args:
        sumo: The libsumo module, with a simulation running.
    """

    def __init__(self, sumo: Any) -> None:
        self._vehicle = sumo.vehicle
        self._refusals = (sumo.TraCIException, sumo.FatalTraCIError)

    def is_taxi(self, name: str) -> bool:
        """Return whether SUMO dispatches a vehicle as a taxi."""
        return self._has(name, "taxi")

    def reroutes(self, name: str) -> bool:
        """Return whether SUMO looks for faster routes of a vehicle on its way.

        Each ``trip`` has the device, too, for its route at the departure; its period is 0.
        """
        return self._has(name, "rerouting") and self._period(name) > 0.0

    def keep_route(self, name: str) -> None:
        """Let SUMO look for no other route of a vehicle that has a device for it."""
        with contextlib.suppress(*self._refusals):
            self._vehicle.setParameter(name, "device.rerouting.period", "0")

    def _period(self, name: str) -> float:
        try:
            return float(self._vehicle.getParameter(name, "device.rerouting.period"))
        except (*self._refusals, ValueError):
            return 0.0

    def _has(self, name: str, device: str) -> bool:
        try:
            return bool(self._vehicle.getParameter(name, f"has.{device}.device") == "true")
        except self._refusals:
            return False
