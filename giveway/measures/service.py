"""Levels of service of walkways: the comfort of a density or a flow, A (free) to F (jammed)."""

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class LevelsOfService:
    """The limits between the levels A to F of one source.

    Attributes:
        source: Publication of the limits.
        space: Space [m^2 per person] above which the level is A, B, C, D, E.
        flow: Flow [persons per minute and metre] up to which it is A, B, C, D, E.
    """

    source: str
    space: tuple[float, float, float, float, float]
    flow: tuple[float, float, float, float, float]


FRUIN = LevelsOfService(
    # 35, 25, 15, 10 and 5 square feet; 7, 10, 15, 20 and 25 persons per minute and foot
    "Fruin 1971, Pedestrian Planning and Design: walkways",
    (3.25, 2.32, 1.39, 0.93, 0.46),
    (23.0, 33.0, 49.0, 66.0, 82.0),
)
HCM = LevelsOfService(
    # 60, 40, 24, 15 and 8 square feet
    "Highway Capacity Manual 2000, exhibit 18-3: average flow on walkways",
    (5.6, 3.7, 2.2, 1.4, 0.75),
    (16.0, 23.0, 33.0, 49.0, 75.0),
)
_LETTERS = "ABCDEF"


def level_of_service(
    levels: LevelsOfService, *, density: float | None = None, specific_flow: float | None = None
) -> str:
    """Return the level of a density, or of a flow.

    A flow alone does not distinguish a free walkway from a jammed one: level F by flow is demand
    beyond capacity. If the density is known, it decides.

    Args:
        levels: Limits, Fruin's or the manual's.
        density: Density [1/m^2] of people.
        specific_flow: Flow [1/(m s)] over a line.
    """
    if density is not None:
        space = 1.0 / density if density > 0.0 else inf
        return _LETTERS[sum(space <= limit for limit in levels.space)]
    per_minute = 60.0 * (specific_flow or 0.0)
    return _LETTERS[sum(per_minute > limit for limit in levels.flow)]
