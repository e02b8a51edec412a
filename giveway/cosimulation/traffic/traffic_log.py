"""The background traffic of a run, second by second, for the counterfactual run."""

from collections.abc import Mapping

import numpy as np

from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.session import SumoSession

_PERIOD = 1.0  # Time [s] between two records
_SAME_PLACE = 0.5  # Distance [m] up to which two positions are the same


class TrafficNotes:
    """Log of traffic lights, positions and lost time of the background traffic.

    Args:
        session: The running simulation.
    """

    def __init__(self, session: SumoSession) -> None:
        self._session = session
        self._every = max(1, round(_PERIOD / session.step_length))
        self._looks = 0
        self._lights: list[Mapping[str, str]] = []
        self._vehicles: list[BackgroundVehicles] = []
        self._losses: dict[str, float] = {}

    def note(self, background: BackgroundVehicles) -> None:
        """Record the traffic after each of SUMO's steps."""
        self._looks += 1
        if (self._looks - 1) % self._every:
            return
        self._lights.append(self._session.light_states(self._session.light_systems))
        self._vehicles.append(background)
        for name in background.ids:
            self._losses[name] = self._session.vehicles.time_loss(name)

    @property
    def time_loss(self) -> float:
        """The time [s] that all background vehicles have lost so far, as SUMO counts it."""
        return float(sum(self._losses.values()))

    @property
    def vehicles(self) -> int:
        """The number of background vehicles."""
        return len(self._losses)

    def differ_from(self, other: "TrafficNotes") -> bool:
        """Return whether lights or vehicles ever differed while both runs were recorded."""
        if any(a != b for a, b in zip(self._lights, other._lights, strict=False)):
            return True
        return any(not _same(a, b) for a, b in zip(self._vehicles, other._vehicles, strict=False))


def _same(a: BackgroundVehicles, b: BackgroundVehicles) -> bool:
    if a.ids != b.ids:
        return False
    apart = np.hypot(a.x - b.x, a.y - b.y)
    return bool((apart <= _SAME_PLACE).all())
