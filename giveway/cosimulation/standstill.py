"""Ends a scenario without an end in which no ego moves any more."""

from collections.abc import Sequence

from giveway.ego.ego import Ego

LONGEST = 3600.0  # [s] without a move
_MOVED = 0.1  # [m] from which on an ego has moved


class Standstill:
    """Watches whether any ego moves."""

    def __init__(self) -> None:
        self._driven = 0.0  # [m] driven by all egos when one last moved
        self._since = 0.0  # [s] that instant

    @property
    def remark(self) -> str:
        """The sentence for the user."""
        return (
            f"no ego moved for {LONGEST:g} s in a scenario without an end, so that the run was "
            "ended; set its end with --time-limit or --sumo-end"
        )

    def too_long(self, egos: Sequence[Ego], time: float) -> bool:
        """Return whether all egos on the road have stood for too long at ``time`` [s]."""
        driven = sum(ego.vehicle.position for ego in egos)
        if not egos or abs(driven - self._driven) > _MOVED:
            self._driven, self._since = driven, time
        return time - self._since >= LONGEST
