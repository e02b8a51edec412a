"""A comparison of a vehicle's mass with known masses; a large factor is a wrong unit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from fmus.profile.vehicle_profile import VehicleProfile

GROSS: Final = 3.0  # Factor in the mass that neither load nor fit explains
NEAR: Final = 1.3  # largest deviation, as a factor, from a ratio of units; loads differ
DOUBTFUL: Final = 1.5  # Factor in the mass from which it is a question whether a unit is wrong
CLOSE: Final = (
    1.08  # largest deviation, as a factor, of a measured factor from the one it is named by
)
FAR: Final = 1.5  # the same for 100 and 1000, which have no neighbours
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
_NAMES: Final = (  # factor of the mass, and the unit that the axis seems to have
    (1000.0, "1000: a thousand times too weak", "N", ("force", "drive_force", "brake_force")),
    (1e-3, "1000 times too strong", "kN", ("force", "drive_force", "brake_force")),
    (100.0, "100 times too weak: per cent", "%", ("throttle", "brake")),
    (0.01, "100 times too strong: no per cent", "1", ("throttle", "brake")),
    (9.80665, "9.81 times too weak", "N", ("force", "drive_force", "brake_force")),
    (1.0 / 9.80665, "9.81 times too strong", "kgf", ("force", "drive_force", "brake_force")),
    (9.80665, "9.81 times too weak", "m/s2", ("acceleration",)),
    (1.0 / 9.80665, "9.81 times too strong", "g0", ("acceleration",)),
    (100.0, "100 times too weak", "cm/s2", ("acceleration",)),
    (0.01, "100 times too strong", "m/s2", ("acceleration",)),
)
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


def known_masses(
    profile: VehicleProfile | None, mass: float | None, vehicle_class: str | None
) -> tuple[KnownMass, ...]:
    """Collect the masses with which the measured one can be compared.

    Args:
        profile: Profile with the identified model. A vehicle that is driven by an acceleration or a
            speed has the mass of its [inverse_map] in the fit, independently of its mass.
        mass: Mass given by the user [kg].
        vehicle_class: SUMO's vehicle class, given by the user.
    """
    known = []
    if profile is not None and (profile.inputs.acceleration or profile.inputs.speed_setpoint):
        seeming = profile.inverse_map.mass
        known.append(KnownMass(seeming, seeming, "[inverse_map] of the profile"))
    elif mass is not None:
        known.append(KnownMass(mass, mass, "--mass"))
    elif vehicle_class is not None:
        known.append(KnownMass(*CLASS_MASSES[vehicle_class], f"--ego-class {vehicle_class}"))
    if profile is not None and profile.model is not None:
        identified = profile.model.mass
        known.append(KnownMass(identified, identified, "[model] of the profile"))
    return tuple(known)


def gross_error(
    measured: float, known: KnownMass, role: str, speed_unit: str
) -> tuple[str, str] | None:
    """Describe a mass that is far from the known one, with the line that corrects it.

    Args:
        measured: Fitted M [kg].
        known: Mass with which it is compared.
        role: Role of the input that drives.
        speed_unit: Unit in which the speed is read.

    Returns:
        Description and line, or None if the mass is within a factor of :data:`GROSS`.
    """
    excess = known.excess(measured)
    if 1.0 / GROSS < excess < GROSS:
        return None
    times = f"{excess:.3g} times" if excess > 1.0 else f"a {1.0 / excess:.3g}th of"
    size = f"{measured:.0f}" if measured >= 100.0 else f"{measured:.3g}"
    text = f"it moves like {size} kg, {times} the {known}"
    for factor, name, unit, roles in _NAMES:
        if role in roles and _fits(factor, measured, known):
            return f"{text}: {name}", f'set `unit = "{unit}"` in [inputs.{role}]'
    for factor, unit in ((3.6, "m/s"), (1.0 / 3.6, "km/h")):
        if _fits(factor, measured, known) and unit != speed_unit:
            return (
                f"{text}: 3.6, the speed seems to be in {unit}",
                f'set `unit = "{unit}"` in [outputs.speed]',
            )
    for factor in (1000.0, 100.0, 9.80665):
        for named in (factor, 1.0 / factor):
            if _fits(named, measured, known):
                return f"{text}: a factor of {factor:.4g}", _elsewhere(role)
    return text, _elsewhere(role)


def _elsewhere(role: str) -> str:
    strength = "`full_force`" if role in {"throttle", "brake"} else "`unit` and `gain`"
    return f"see {strength} in [inputs.{role}], and `unit` in [outputs.speed]"


def _fits(factor: float, measured: float, known: KnownMass) -> bool:
    """Return whether a known mass times ``factor`` is the measured one."""
    near = NEAR if 0.05 < factor < 20.0 else FAR
    return known.low / near <= measured / factor <= known.high * near
