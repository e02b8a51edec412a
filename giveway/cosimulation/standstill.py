"""The end of a scenario without an end, after no ego has moved for a long time."""

from collections.abc import Sequence

from giveway.ego.ego import Ego

LONGEST = 3600.0  # Longest time [s] in which no ego moves
_MOVED = 0.1  # Distance [m] from which on an ego has moved


class Standstill:
    """Watches whether any ego moves."""

    def __init__(self) -> None:
        self._driven = 0.0  # distance [m] driven by all egos when one last moved
        self._since = 0.0  # that instant [s]

    @property
    def remark(self) -> str:
        """The remark for the user."""
        return (
            f"no ego moved for {LONGEST:g} s in a scenario without an end, so that the run was "
            "ended; set its end with --time-limit"
        )

    def too_long(self, egos: Sequence[Ego], time: float) -> bool:
        """Return whether all egos on the road have stood for too long at ``time`` [s]."""
        driven = sum(ego.vehicle.position for ego in egos)
        if not egos or abs(driven - self._driven) > _MOVED:
            self._driven, self._since = driven, time
        return time - self._since >= LONGEST
