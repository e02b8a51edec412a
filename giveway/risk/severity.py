"""The severity of an impact: the probability of an injury by published curves.

Each curve holds for the people, the vehicle's front and the speeds of its data. Outside of them
there is no number. docs/risk.md has the sources.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

_KMH = 3.6  # km/h in a m/s
_MPH = 1.609344  # km/h in a mile per hour
# Tefft 2013: impact speeds [mph] at which the average risk of death reaches these shares
_TEFFT_SPEEDS = np.array([24.1, 32.5, 40.6, 48.0, 54.6]) * _MPH
_TEFFT_SHARES = np.array([0.10, 0.25, 0.50, 0.75, 0.90])
# Monfort & Mueller 2025: means of the sample, about which the model is centred
_MEAN_SPEED, _MEAN_HEIGHT, _MEAN_MALE, _MEAN_AGE = 42.79, 85.25, 0.59, 42.42
_CAR_HEIGHT = 75.0  # Height [cm] of a car's bonnet edge
_SLOWEST = 25.0  # Speed [km/h] below which the model of Monfort & Mueller does not hold
_DEATH, _MAIS3 = "death", "MAIS3+"


@dataclass(frozen=True)
class Curve:
    """A published curve.

    Attributes:
        name: Authors and year.
        outcome: Injury whose probability it gives: death or MAIS3+.
        slowest, fastest: Range of impact speeds [km/h] in which it holds.
        probability: Function of the impact speed [km/h].
    """

    name: str
    outcome: str
    slowest: float
    fastest: float
    probability: Callable[[float], float]

    def at(self, speed: float) -> float:
        """Return the probability at a speed [m/s] of a frontal impact, or nan outside validity."""
        kmh = _KMH * speed
        return self.probability(kmh) if self.slowest <= kmh <= self.fastest else math.nan


def rosen_sander(speed: float, age: float | None = None) -> float:
    """Return the probability of death by Rosén & Sander (2009).

    Args:
        speed: Impact speed [km/h].
        age: Age [years] of an adult, or None for the mean over all.
    """
    if age is None:
        return _logistic(-6.9 + 0.090 * speed)
    return _logistic(-9.1 + 0.095 * speed + 0.040 * age)


def monfort_mueller(
    speed: float,
    outcome: str,
    height: float = _CAR_HEIGHT,
    male: float = _MEAN_MALE,
    age: float = _MEAN_AGE,
) -> float:
    """Return the probability of MAIS3+ or death by Monfort & Mueller (2025).

    Args:
        speed: Impact speed [km/h].
        outcome: Outcome, "MAIS3+" or "death".
        height: Height [cm] of the bonnet's edge.
        male: Share of men, or 0 or 1.
        age: Age [years].
    """
    base, b_v, b_h, b_s, b_a, b_vh = {
        _MAIS3: (-0.460, 0.091, 0.039, -0.119, 0.029, 0.002),
        _DEATH: (-3.280, 0.123, 0.047, 0.319, 0.030, 0.0),
    }[outcome]
    v, h = speed - _MEAN_SPEED, height - _MEAN_HEIGHT
    others = b_s * (male - _MEAN_MALE) + b_a * (age - _MEAN_AGE)
    return _logistic(base + b_v * v + b_h * h + b_vh * v * h + others)


def tefft(speed: float) -> float:
    """Return the probability of death by Tefft (2013), between its five published points.

    The log-odds are interpolated linearly.

    Args:
        speed: Impact speed [km/h].
    """
    odds = np.log(_TEFFT_SHARES / (1.0 - _TEFFT_SHARES))
    return _logistic(float(np.interp(speed, _TEFFT_SPEEDS, odds)))


def _logistic(eta: float) -> float:
    return 1.0 / (1.0 + math.exp(-eta))


CURVES = (
    Curve("Rosén & Sander 2009", _DEATH, 0.0, math.inf, rosen_sander),
    Curve(
        "Monfort & Mueller 2025",
        _DEATH,
        _SLOWEST,
        math.inf,
        lambda speed: monfort_mueller(speed, _DEATH),
    ),
    Curve("Tefft 2013", _DEATH, float(_TEFFT_SPEEDS[0]), float(_TEFFT_SPEEDS[-1]), tefft),
    Curve(
        "Monfort & Mueller 2025",
        _MAIS3,
        _SLOWEST,
        math.inf,
        lambda speed: monfort_mueller(speed, _MAIS3),
    ),
)
"""The curves; the first one is the default for deaths."""


def injury_at_contact(row: Mapping[str, Any]) -> float:
    """Return the probability of MAIS3+ at an ego's frontal contact; nan outside validity."""
    curve = next(one for one in CURVES if one.outcome == _MAIS3)
    is_child = not math.isnan(_speed(row, "child_impact_speed"))
    return math.nan if is_child else curve.at(_speed(row, "adult_impact_speed"))


@dataclass(frozen=True)
class Severity:
    """The injuries at the frontal contacts of all runs, by one curve.

    Attributes:
        curve: Name of the curve.
        outcome: Injury: death or MAIS3+.
        impacts: Number of frontal contacts; of an ego the fastest with an adult, and with a child.
        children: Number of these with a child, for whom no curve holds.
        valid: Number of these for which the curve holds.
        mean: Mean probability of the injury in these; nan if there is none.
    """

    curve: str
    outcome: str
    impacts: int
    children: int
    valid: int
    mean: float

    @property
    def holds_for_adults(self) -> bool:
        """True if the curve holds for every contact with an adult."""
        return self.impacts - self.children == self.valid > 0


def severities(rows: Sequence[Mapping[str, Any]]) -> list[Severity]:
    """Return the injuries by each curve.

    Args:
        rows: Summaries of the egos of all runs.
    """
    adults, children = (
        [speed for row in rows if not math.isnan(speed := _speed(row, name))]
        for name in ("adult_impact_speed", "child_impact_speed")
    )
    found = []
    for curve in CURVES:
        valid = [risk for speed in adults if not math.isnan(risk := curve.at(speed))]
        mean = float(np.mean(valid)) if valid else math.nan
        impacts = len(adults) + len(children), len(children)
        found.append(Severity(curve.name, curve.outcome, *impacts, len(valid), mean))
    return found


def _speed(row: Mapping[str, Any], name: str) -> float:
    speed = row.get(name)
    return math.nan if speed is None else float(speed)
