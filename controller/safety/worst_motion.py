"""The worst motion that a safety layer expects of people: named bounds with their sources.

The bounds are of the kinds that IEEE Std 2846-2022 names for people on foot, the largest speed and
the largest acceleration in any direction; and a smaller one for those who are on a sidewalk, as in
set-based prediction that knows the rules of the road (Koschi, Pek, Beikirch & Althoff, ITSC 2018).
``docs/safety.md`` says how they were found, and what is promised to whom.
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
    """The limits that a person is taken to keep to.

    Raises:
        ParameterError: a value is not a positive number.
    """

    acceleration: float  # [m/s^2] in any direction
    speed: float  # [m/s]
    setting_out: float = inf  # [m/s^2] towards the road, while on a sidewalk; inf: as anywhere

    def __post_init__(self) -> None:
        require_positive("acceleration", self.acceleration, "m/s^2")
        require_positive("speed", self.speed, "m/s")
        require(self.setting_out > 0.0, "setting_out", self.setting_out, "a number > 0 [m/s^2]")


_SETTING_OUT = 0.6
"""[m/s^2] All that SPOT, the tool of Koschi et al., takes people on foot to accelerate by."""

#: The larger one of two data sets' percentiles, rounded up (CITR and DUT, Yang et al. 2019, arXiv
#: 1902.00487: people within 5 m of a moving vehicle, smoothed over 0.5 s).
RECORDED: Final[Mapping[str, WorstMotion]] = MappingProxyType(
    {
        "recorded-99.9": WorstMotion(3.0, 3.3, _SETTING_OUT),  # 99.9 % of the frames
        "responsible": WorstMotion(2.2, 2.8, _SETTING_OUT),  # 99 %: reasonably foreseeable
    }
)


def worst_motion(name: PeopleName, limits: WorstMotion) -> WorstMotion:
    """The bounds of that name; the speed is never below that of the simulated people.

    Args:
        name: ``worst-case``: whatever the simulated people are able to do.
        limits: Limits of the simulated people.
    """
    recorded = RECORDED.get(name)
    if recorded is None:
        return limits
    return replace(recorded, speed=max(recorded.speed, limits.speed))
