"""Wording: how numbers, units and identities are written in a report."""

import math

from giveway.run_data.writing import digits_for, number, pretty_unit

__all__ = [
    "counted",
    "digits_for",
    "interval",
    "number",
    "pretty_unit",
    "quantity",
    "quantity_of",
    "share",
    "shown_ego",
]

_USUAL_EGO = frozenset({"", "ego"})


def shown_ego(ego: object) -> str:
    """Return the ego's id in brackets, or "" for the default ego."""
    return "" if str(ego) in _USUAL_EGO else f" (ego {ego})"


def counted(count: int, noun: str) -> str:
    """Return a number and what it counts: "1 run", "2,000 runs"."""
    return f"{count:,} {noun}" if count == 1 else f"{count:,} {noun}s"


def quantity(value: float, unit: str, digits: int = 2) -> str:
    """Return a number with its unit: "−0.57 s"."""
    text = number(value, digits)
    return f"{text} {pretty_unit(unit)}" if unit and math.isfinite(value) else text


def quantity_of(value: float, unit: str) -> str:
    """Return a number with all its digits and its unit: "0.4 s"."""
    return f"{value:g} {pretty_unit(unit)}".rstrip()


def interval(low: float, high: float, unit: str = "") -> str:
    """Return both ends as in "−0.84 to −0.31 s", or a dash without an interval."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "–"
    digits = digits_for(high - low)
    return f"{number(low, digits)} to {quantity(high, unit, digits)}"


def share(value: float) -> str:
    """Return a share in per cent."""
    return f"{100.0 * value:.1f} %" if math.isfinite(value) else "–"
