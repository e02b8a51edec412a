"""The outlines of vehicles."""

from dataclasses import dataclass


@dataclass(frozen=True)
class VehicleShape:
    """A rectangle, placed by the centre of its front bumper and its heading."""

    length: float = 5.0  # [m]
    width: float = 2.0  # [m]


BODY = VehicleShape()
"""Body of an ego if neither the options nor SUMO give one (Yang & Özgüner 2019: 5 m by 2 m)."""
