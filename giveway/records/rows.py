"""One row of an ego's table, and what the ledger of pedestrians counts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from giveway.geometry.path import Pose

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
    iterations: int


LEDGER = ("added", "taken_over", "handed_back", "arrived", "continued", "walking")
"""What the ledger of pedestrians counts, in order."""
