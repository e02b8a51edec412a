"""The units by their names, such as ``km/h`` in an FMU that does not define it.

SI = factor * raw + offset. A name is a product of known symbols in the notations that tools write:
``m/s2``, ``m.s-2``, ``m/s^2``, ``m*s**-2``, ``m/s²``, ``N.s/m``, ``kg/(m.s2)``. Capitals matter:
``kN`` is a force, ``kn`` a speed.
"""

import dataclasses
import functools
import math
import re
import unicodedata
from typing import Final, NamedTuple

from fmus.description.model import Dimension, Unit

NONE: Final[Dimension] = (0, 0, 0, 0, 0, 0, 0, 0)
MASS: Final[Dimension] = (1, 0, 0, 0, 0, 0, 0, 0)
LENGTH: Final[Dimension] = (0, 1, 0, 0, 0, 0, 0, 0)
TIME: Final[Dimension] = (0, 0, 1, 0, 0, 0, 0, 0)
ANGLE: Final[Dimension] = (0, 0, 0, 0, 0, 0, 0, 1)
SPEED: Final[Dimension] = (0, 1, -1, 0, 0, 0, 0, 0)
ACCELERATION: Final[Dimension] = (0, 1, -2, 0, 0, 0, 0, 0)
FORCE: Final[Dimension] = (1, 1, -2, 0, 0, 0, 0, 0)
TORQUE: Final[Dimension] = (1, 2, -2, 0, 0, 0, 0, 0)  # torque and energy
POWER: Final[Dimension] = (1, 2, -3, 0, 0, 0, 0, 0)
FRICTION: Final[Dimension] = (1, 0, -1, 0, 0, 0, 0, 0)  # force per speed
TURNING: Final[Dimension] = (0, 0, -1, 0, 0, 0, 0, 1)
TEMPERATURE: Final[Dimension] = (0, 0, 0, 0, 1, 0, 0, 0)
CURRENT: Final[Dimension] = (0, 0, 0, 1, 0, 0, 0, 0)
VOLTAGE: Final[Dimension] = (1, 2, -3, -1, 0, 0, 0, 0)
PRESSURE: Final[Dimension] = (1, -1, -2, 0, 0, 0, 0, 0)
FREQUENCY: Final[Dimension] = (0, 0, -1, 0, 0, 0, 0, 0)

WORDS: Final[dict[Dimension, str]] = {
    NONE: "a plain number",
    MASS: "a mass",
    LENGTH: "a length",
    TIME: "a time",
    ANGLE: "an angle",
    SPEED: "a speed",
    ACCELERATION: "an acceleration",
    FORCE: "a force",
    TORQUE: "a torque or an energy",
    POWER: "a power",
    FRICTION: "a force per speed",
    TURNING: "an angular speed",
    TEMPERATURE: "a temperature",
    CURRENT: "a current",
    VOLTAGE: "a voltage",
    PRESSURE: "a pressure",
    FREQUENCY: "a frequency",
}
COMMON: Final[dict[Dimension, str]] = {  # units that a user may have meant
    NONE: "1, %",
    LENGTH: "m, km, ft",
    SPEED: "m/s, km/h, mph",
    ACCELERATION: "m/s2, g0",
    FORCE: "N, kN, lbf",
}


class _Symbol(NamedTuple):
    factor: float
    dimension: Dimension
    offset: float = 0.0


G_0: Final = 9.80665  # [m/s2] standard gravity
POUND: Final = 0.45359237  # [kg]
FOOT: Final = 0.3048  # [m]
MILE: Final = 1609.344  # [m]
NAUTICAL_MILE: Final = 1852.0  # [m]
HOUR: Final = 3600.0  # [s]
HORSEPOWER: Final = 550 * FOOT * POUND * G_0  # [W] mechanical
METRIC_HORSEPOWER: Final = 75 * G_0  # [W]

# BIPM, The International System of Units, 9th ed. (2019); NIST SP 811 (2008) for the others.
PREFIXED: Final = {  # take k, M, m, ...
    "g": _Symbol(1e-3, MASS),
    "m": _Symbol(1.0, LENGTH),
    "s": _Symbol(1.0, TIME),
    "N": _Symbol(1.0, FORCE),
    "W": _Symbol(1.0, POWER),
    "J": _Symbol(1.0, TORQUE),
    "Pa": _Symbol(1.0, PRESSURE),
    "bar": _Symbol(1e5, PRESSURE),
    "A": _Symbol(1.0, CURRENT),
    "V": _Symbol(1.0, VOLTAGE),
    "K": _Symbol(1.0, TEMPERATURE),
    "Hz": _Symbol(1.0, FREQUENCY),
    "rad": _Symbol(1.0, ANGLE),
    "Nm": _Symbol(1.0, TORQUE),
}
PREFIXES: Final = {
    "G": 1e9,
    "M": 1e6,
    "k": 1e3,
    "h": 1e2,
    "da": 1e1,
    "d": 1e-1,
    "c": 1e-2,
    "m": 1e-3,
    "u": 1e-6,
    "\N{GREEK SMALL LETTER MU}": 1e-6,
    "n": 1e-9,
}
_ONE: Final = _Symbol(1.0, NONE)
SYMBOLS: Final = {
    **dict.fromkeys(("km/h", "kmh", "kph", "kmph", "km/hr"), _Symbol(1000.0 / HOUR, SPEED)),
    **dict.fromkeys(("mph", "mi/h"), _Symbol(MILE / HOUR, SPEED)),
    **dict.fromkeys(("kn", "kt", "kts", "knot", "knots"), _Symbol(NAUTICAL_MILE / HOUR, SPEED)),
    "fps": _Symbol(FOOT, SPEED),
    **dict.fromkeys(("g0", "g_0", "gn", "g_n", "gee"), _Symbol(G_0, ACCELERATION)),
    **dict.fromkeys(("lbf", "lb_f"), _Symbol(POUND * G_0, FORCE)),
    **dict.fromkeys(("kgf", "kg_f", "kp"), _Symbol(G_0, FORCE)),
    "tf": _Symbol(1000 * G_0, FORCE),
    **dict.fromkeys(("newton", "newtons"), _Symbol(1.0, FORCE)),
    "t": _Symbol(1000.0, MASS),
    **dict.fromkeys(("lb", "lbs", "lbm", "lb_m"), _Symbol(POUND, MASS)),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), _Symbol(1.0, LENGTH)),
    **dict.fromkeys(("mi", "mile", "miles"), _Symbol(MILE, LENGTH)),
    **dict.fromkeys(("ft", "foot", "feet"), _Symbol(FOOT, LENGTH)),
    **dict.fromkeys(("in", "inch", "inches"), _Symbol(FOOT / 12, LENGTH)),
    "yd": _Symbol(3 * FOOT, LENGTH),
    **dict.fromkeys(("nmi", "NM"), _Symbol(NAUTICAL_MILE, LENGTH)),
    **dict.fromkeys(("sec", "second", "seconds"), _Symbol(1.0, TIME)),
    **dict.fromkeys(("min", "minute", "minutes"), _Symbol(60.0, TIME)),
    **dict.fromkeys(("h", "hr", "hour", "hours"), _Symbol(HOUR, TIME)),
    "d": _Symbol(24 * HOUR, TIME),
    **dict.fromkeys(
        ("deg", "degree", "degrees", "\N{DEGREE SIGN}"), _Symbol(math.pi / 180.0, ANGLE)
    ),
    **dict.fromkeys(("radian", "radians"), _Symbol(1.0, ANGLE)),
    **dict.fromkeys(("rev", "revs"), _Symbol(2 * math.pi, ANGLE)),
    **dict.fromkeys(("rpm", "r/min"), _Symbol(2 * math.pi / 60.0, TURNING)),
    "PS": _Symbol(METRIC_HORSEPOWER, POWER),
    "hp": _Symbol(HORSEPOWER, POWER),
    "Ns": _Symbol(1.0, (1, 1, -1, 0, 0, 0, 0, 0)),
    "Wh": _Symbol(HOUR, TORQUE),
    "kWh": _Symbol(1000 * HOUR, TORQUE),
    "psi": _Symbol(POUND * G_0 / (FOOT / 12) ** 2, PRESSURE),
    "mol": _Symbol(1.0, (0, 0, 0, 0, 0, 1, 0, 0)),
    "cd": _Symbol(1.0, (0, 0, 0, 0, 0, 0, 1, 0)),
    **dict.fromkeys(("degC", "\N{DEGREE SIGN}C"), _Symbol(1.0, TEMPERATURE, 273.15)),
    **dict.fromkeys(("degF", "\N{DEGREE SIGN}F"), _Symbol(5 / 9, TEMPERATURE, 459.67 * 5 / 9)),
    **dict.fromkeys(("%", "percent", "pct"), _Symbol(1e-2, NONE)),
    **dict.fromkeys(("1", "-", "--", "none", "unitless", "dimensionless"), _ONE),
}
# Written with other capitals, these names mean the same.
ANY_CASE: Final = frozenset(
    {"km/h", "kmh", "kph", "mph", "m/s", "m/s2", "m/s^2", "rpm", "deg", "rad", "knots", "percent"}
)
MAX_NAME: Final = 60
FACTOR: Final = re.compile(
    r"(?P<symbol>[^\W\d]+(?:_[^\W\d]+)?|%|\N{DEGREE SIGN}[CF]?|1(?!\d))"
    r"(?:(?:\^|\*\*)?(?:(?P<power>[+-]?\d)|\((?P<bracketed>[+-]?\d)\)))?(?!\d)"
)
TIMES: Final = re.compile(r"\s*(?:\*|\.|\N{MIDDLE DOT}|\N{DOT OPERATOR}|\s)\s*")


def to_si(unit: Unit) -> Unit:
    """Return the unit with its dimension and conversion to SI, by name if the FMU has none.

    An empty definition (``<BaseUnit/>``) of a name that has a dimension, such as ``m/s``, counts as
    no definition.

    Returns:
        The unit; its dimension stays None if the name is unknown.
    """
    defined = unit.dimension is not None
    empty = unit.dimension == NONE and unit.factor == 1.0 and unit.offset == 0.0
    if defined and not empty:
        return unit
    symbol = _by_name(unit.name)
    if symbol is None:
        return unit
    return dataclasses.replace(
        unit, factor=symbol.factor, offset=symbol.offset, dimension=symbol.dimension
    )


def named(name: str) -> Unit:
    """Return the unit of a name, as a profile gives it."""
    return to_si(Unit(name))


def quantity(dimension: Dimension | None) -> str:
    """Return the quantity of a dimension, such as "a force", or its exponents without a name."""
    if dimension is None:
        return "unknown"
    symbols = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
    powers = (
        f"{symbol}{power if power != 1 else ''}"
        for symbol, power in zip(symbols, dimension, strict=True)
        if power
    )
    return WORDS.get(dimension) or f"a quantity in {'.'.join(powers)}"


@functools.lru_cache(maxsize=1024)
def _by_name(name: str) -> _Symbol | None:
    text = unicodedata.normalize("NFKC", name).replace("\N{MINUS SIGN}", "-").strip()
    if text.startswith("[") and text.endswith("]"):
        text = text[1:-1].strip()
    if not text or len(text) > MAX_NAME:
        return None
    for spelling in (text, text.lower() if text.lower() in ANY_CASE else text):
        symbol = SYMBOLS.get(spelling) or _prefixed(spelling) or _Parser(spelling).unit()
        if symbol is not None:
            return symbol
    return None


def _prefixed(text: str) -> _Symbol | None:
    if text in PREFIXED:
        return PREFIXED[text]
    for prefix, factor in PREFIXES.items():
        symbol = PREFIXED.get(text.removeprefix(prefix)) if text.startswith(prefix) else None
        if symbol is not None:
            # Through a whole number where there is one: mm is 1 / 1000 m to the last bit.
            scale = symbol.factor * factor if factor > 1 else symbol.factor / round(1 / factor)
            return _Symbol(scale, symbol.dimension)
    return None


class _Parser:
    """product := factor {("." | "*" | "/") factor}; factor := symbol [power] | "(" product ")"."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.place = 0

    def unit(self) -> _Symbol | None:
        """Return the whole text as a unit, or None if it is not one."""
        product = self._product()
        return product if self.place == len(self.text) else None

    def _product(self) -> _Symbol | None:
        product = self._factor()
        while product is not None and self.place < len(self.text):
            if self.text[self.place] == "/":
                self.place += 1
                sign = -1
            elif match := TIMES.match(self.text, self.place):
                self.place = match.end()
                sign = 1
            else:
                break
            factor = self._factor()
            product = None if factor is None else _times(product, factor, sign)
        return product

    def _factor(self) -> _Symbol | None:
        if self.text.startswith("(", self.place):
            self.place += 1
            inner = self._product()
            if not self.text.startswith(")", self.place):
                return None
            self.place += 1
            return inner
        match = FACTOR.match(self.text, self.place)
        if match is None:
            return None
        self.place = match.end()
        symbol = SYMBOLS.get(match["symbol"]) or _prefixed(match["symbol"])
        power = int(match["power"] or match["bracketed"] or 1)
        return symbol and _times(_ONE, symbol, power)


def _times(one: _Symbol, other: _Symbol, power: int) -> _Symbol:
    """Return the product of two units; offsets, as that of degC, have no meaning in products."""
    exponents = (a + power * b for a, b in zip(one.dimension, other.dimension, strict=True))
    factor = one.factor * other.factor**power if power > 0 else one.factor / other.factor**-power
    kg, m, s, a, k, mol, cd, rad = exponents
    return _Symbol(factor, (kg, m, s, a, k, mol, cd, rad))
