"""What a safety layer takes people to be able to do at worst: named bounds, each with its source.

The bounds are of the kinds that IEEE Std 2846-2022 names for people on foot, the largest speed and
the largest acceleration in any direction. ``docs/safety.md`` says how they were found, and what is
promised to whom.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

from controller.parameters import require_positive

PeopleName = Literal["worst-case", "recorded-99.9", "responsible"]


@dataclass(frozen=True, slots=True)
class WorstMotion:
    """The limits that a person is taken to keep to.

    Raises:
        ParameterError: a value is not a positive number.
    """

    acceleration: float  # [m/s^2] in any direction
    speed: float  # [m/s]

    def __post_init__(self) -> None:
        require_positive("acceleration", self.acceleration, "m/s^2")
        require_positive("speed", self.speed, "m/s")


#: The larger one of two data sets' percentiles, rounded up (CITR and DUT, Yang et al. 2019, arXiv
#: 1902.00487: people within 5 m of a moving vehicle, smoothed over 0.5 s).
RECORDED: Final[Mapping[str, WorstMotion]] = MappingProxyType(
    {
        "recorded-99.9": WorstMotion(acceleration=3.0, speed=3.3),  # 99.9 % of the frames
        "responsible": WorstMotion(acceleration=2.2, speed=2.8),  # 99 %: reasonably foreseeable
    }
)


def worst_motion(name: PeopleName, limits: WorstMotion) -> WorstMotion:
    """The bounds of that name; the speed is never below that of the simulated people.

    Args:
        name: ``worst-case``: whatever the simulated people are able to do.
        limits: of the simulated people.
    """
    recorded = RECORDED.get(name)
    if recorded is None:
        return limits
    return WorstMotion(recorded.acceleration, max(recorded.speed, limits.speed))
