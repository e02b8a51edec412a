"""The worst motion that a safety layer assumes of people: named bounds with their sources.

IEEE Std 2846-2022 names two kinds of bounds for people on foot: the largest speed, and the largest
acceleration in any direction. A smaller acceleration holds for people on a sidewalk, as in
set-based prediction that knows the rules of the road (Koschi, Pek, Beikirch & Althoff, ITSC 2018).
``docs/safety.md`` says how the bounds were found, and what the safety layer guarantees.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from types import MappingProxyType
from typing import Final, Literal

from controller.parameters import require, require_positive

PeopleName = Literal["worst-case", "recorded-99.9", "responsible"]


@dataclass(frozen=True, slots=True)
class WorstMotion:
    """The limits that a person's motion is assumed to keep to.

    Raises:
        ParameterError: a value is not a positive number.
    """

    acceleration: float  # largest acceleration [m/s^2] in any direction
    speed: float  # largest speed [m/s]
    setting_out: float = inf  # largest acceleration [m/s^2] from a sidewalk towards the road

    def __post_init__(self) -> None:
        require_positive("acceleration", self.acceleration, "m/s^2")
        require_positive("speed", self.speed, "m/s")
        require(self.setting_out > 0.0, "setting_out", self.setting_out, "a number > 0 [m/s^2]")


_SETTING_OUT = 0.6
"""Largest acceleration [m/s^2] of people on foot in SPOT, the tool of Koschi et al."""

#: Larger percentile of two data sets, rounded up (CITR and DUT, Yang et al. 2019, arXiv 1902.00487:
#: people within 5 m of a moving vehicle, smoothed over 0.5 s). docs/safety.md has the share of
#: people at each site who keep to them.
RECORDED: Final[Mapping[str, WorstMotion]] = MappingProxyType(
    {
        "recorded-99.9": WorstMotion(3.0, 3.3, _SETTING_OUT),  # percentile 99.9 of the frames
        "responsible": WorstMotion(2.2, 2.8, _SETTING_OUT),  # percentile 99: reasonably foreseeable
    }
)


def worst_motion(name: PeopleName, limits: WorstMotion) -> WorstMotion:
    """The bounds of this name, with a speed that is never below that of the simulated people.

    Args:
        name: Name of the bounds; ``worst-case`` stands for the limits of the simulated people.
        limits: Limits of the simulated people.
    """
    recorded = RECORDED.get(name)
    if recorded is None:
        return limits
    return replace(recorded, speed=max(recorded.speed, limits.speed))
