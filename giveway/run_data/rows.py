"""One row of an ego's table, and what the ledger of pedestrians counts."""

from typing import NamedTuple

from giveway.geometry.path import Pose

STOP_SPEED = 0.2
"""[m/s] Below it the ego stands: Yang & Özgüner 2019, section 2.1, treat it as an obstacle then."""

EGO_NUMBERS = 12  # of an EgoRow, the pose's three among them


class EgoRow(NamedTuple):
    """An ego at one control instant, in the order of :class:`EgoTrack`'s arrays."""

    time: float
    position: float
    pose: Pose
    speed: float
    acceleration: float
    force: float
    gap: float
    reference_speed: float
    vehicle_gap: float
    stop_gap: float
    acting: str
    reason: str
    status: str
    waits_for: str
    iterations: int


LEDGER = ("added", "taken_over", "handed_back", "arrived", "continued", "walking")
"""What the ledger of pedestrians counts, in order."""
