"""A comparison of a vehicle's mass with known masses; a large factor is a wrong unit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

GROSS: Final = 3.0  # Factor in the mass that neither load nor fit explains
DOUBTFUL: Final = 1.5  # Factor in the mass from which it is a question whether a unit is wrong
CLOSE: Final = (
    1.08  # largest deviation, as a factor, of a measured factor from the one it is named by
)
CLASS_MASSES: Final[Mapping[str, tuple[float, float]]] = {
    # [kg] empty to fully loaded, by SUMO's vehicle class (EU 2018/858: M1 and N1 up to 3.5 t;
    # EU 96/53: 44 t for articulated vehicles, 19.5 t for buses on two axles, 28 t on more)
    **dict.fromkeys(("passenger", "private", "taxi", "hov", "evehicle", "vip"), (500.0, 3500.0)),
    "delivery": (900.0, 3500.0),
    **dict.fromkeys(("emergency", "authority", "army"), (900.0, 26000.0)),
    "truck": (3500.0, 32000.0),
    "trailer": (7000.0, 44000.0),
    "bus": (4000.0, 28000.0),
    "coach": (7000.0, 28000.0),
    "tram": (15000.0, 90000.0),
    "motorcycle": (150.0, 600.0),
    **dict.fromkeys(("moped", "scooter"), (100.0, 350.0)),
    "bicycle": (50.0, 250.0),
}
NAMED: Final = (
    (1.943844, "knots 1.94"), (2.0, "2"), (2.236936, "mph 2.24"), (3.6, "km/h 3.6"),
    (4.448222, "lbf 4.45"), (9.80665, "kgf 9.81"), (100.0, "100"), (1000.0, "1000"),
)  # fmt: skip


def named(factor: float) -> str:
    """Return a factor as text, with the named factors that are close to it."""
    size = max(factor, 1.0 / factor)
    close = [name for value, name in NAMED if max(size / value, value / size) <= CLOSE]
    return f"a factor of {size:.3g}" + (f" (near {', '.join(close)})" if close else "")


@dataclass(frozen=True)
class KnownMass:
    """A mass of the vehicle from one source.

    Attributes:
        low: Lower bound [kg].
        high: Upper bound [kg].
        origin: Source of the statement.
    """

    low: float
    high: float
    origin: str

    def __str__(self) -> str:
        span = f"{self.low:g}" if self.low == self.high else f"{self.low:g} to {self.high:g}"
        return f"{span} kg ({self.origin})"

    def excess(self, mass: float) -> float:
        """Return the factor by which a mass [kg] is outside these bounds; 1 within them."""
        return mass / min(max(mass, self.low), self.high)
