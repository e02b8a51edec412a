"""The lines to write into a profile, given its present contents."""

from fmus.profile.tables import Axis
from fmus.profile.vehicle_profile import VehicleProfile


def gain_line(
    profile: VehicleProfile | None, table: str, role: str, factor: float, quote: str = "`"
) -> str:
    """Return the line that multiplies an axis's gain: ``gain = 1.0`` for ``gain = -1.0``.

    Args:
        profile: Profile of the vehicle, or None without a gain.
        table: ``inputs`` or ``outputs``.
        role: Role of the table.
        factor: Factor by which the gain is wrong.
        quote: Quote before and after each line.
    """
    axis = getattr(getattr(profile, table), role, None) if profile is not None else None
    present = axis.gain if isinstance(axis, Axis) else None
    line = f"{quote}gain = {_number(factor * (present or 1.0))}{quote}"
    place = f"in [{table}.{role}]"
    if present is None:
        return f"{line} {place}"
    return f"{line} in place of {quote}gain = {_number(present)}{quote} {place}"


def _number(value: float) -> str:
    return repr(float(f"{value:.6g}"))
