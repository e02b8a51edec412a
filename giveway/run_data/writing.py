"""The format of numbers and units in pictures and on pages."""

import math

import numpy as np


def number(value: float, digits: int = 2) -> str:
    """Return a number with a true minus sign, or "N.A." if it is nan."""
    if not math.isfinite(value):
        return "N.A."
    text = f"{value:.{digits}f}"
    if float(text) == 0.0:
        text = text.removeprefix("-")
    return text.replace("-", "−")


def digits_for(width: float) -> int:
    """Return the decimals that show an interval of this width with two significant digits."""
    if not math.isfinite(width) or width <= 0.0:
        return 2
    if 1.0 <= width < 10.0:
        return 2
    return int(np.clip(1 - math.floor(math.log10(width)), 0, 4))


def with_unit(text: str, unit: str) -> str:
    """Return text and unit, as "Time [s]", or the text alone without a unit."""
    return f"{text} [{pretty_unit(unit)}]" if unit else text


def pretty_unit(unit: str) -> str:
    """Return the unit as it is printed: m/s², not m/s^2."""
    return unit.replace("^2", "²").replace("^3", "³").replace(".", "·")
