"""The statuses that functions of FMI return."""

from typing import Final

WARNING: Final = 1  # the last FMI status with which a call has done what it should
DISCARD: Final = 2
ERROR: Final = 3
FATAL: Final = 4
PENDING: Final = 5
ENDED: Final = 6  # not FMI's: the FMU asked to end the simulation
STATUS_NAMES: Final = (
    "OK", "warning", "discard", "error", "fatal", "pending", "end of the simulation",
)  # fmt: skip


def named(status: int) -> str:
    """Return a status in words."""
    return f"'{STATUS_NAMES[status]}'" if 0 <= status < len(STATUS_NAMES) else f"status {status}"
