"""The objective of a fit for behaviour: how unlike recorded people simulated ones are.

For each site it is the sum of the mean ratio of all measures to their noise floors, with more
weight on ratios above 1.5; the logarithms of the quotients of the 95 % accelerations; contacts and
close passes above the recorded ones; and the difference of the shares of people who go first. To
the mean of the sites comes what the speeds in corridors lack of Weidmann's, beyond 10 %.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from giveway.config import RunConfig
from giveway.validation.behaviour.comparison import Counts, Yardstick, counts_of, hardest
from giveway.validation.behaviour.corridor import walk, weidmann
from giveway.validation.behaviour.measures import CHANGE, MEASURES, together
from pedestrian_model import CrowdModel, VciParameters

_ENOUGH = 0.8  # Ratio below which nothing is gained: two halves of the people differ by 1
_LARGE, _LARGER = 1.5, 0.3  # Ratio above which a measure counts more, and by how much
_CONTACT, _CLOSE, _FIRST, _CORRIDOR = 20.0, 15.0, 2.0, 2.0  # Weights
_ALIKE = 0.1  # Logarithm of the quotient to Weidmann's speeds that is good enough
_DURATION, _STEP = 16.0, 0.05  # Time and time step [s] in the corridors
FAILED = 99.0
"""Value of parameters with which people tremble, leave the numbers or meet nobody."""


@dataclass(frozen=True)
class Likeness:
    """The likeness of simulated to recorded people, at one site.

    Attributes:
        ratios: Ratio of each measure, by its name.
        mean: Mean ratio of ``MEASURES``.
        recorded, simulated: Counts.
        near: Number of recorded people near a moving vehicle.
        hardness: Quotients of the 95 % accelerations, by positions and over 0.2 s.
    """

    ratios: dict[str, float]
    mean: float
    recorded: Counts
    simulated: Counts
    near: int
    hardness: tuple[float, float]

    @property
    def value(self) -> float:
        """The site's part of the objective."""
        ratios = np.array(list(self.ratios.values()))
        found = float(np.mean(np.maximum(ratios, _ENOUGH)))
        found += _LARGER * float(np.mean(np.maximum(ratios - _LARGE, 0.0)))
        by_position, over_short = (abs(math.log(max(each, 0.01))) for each in self.hardness)
        found += by_position + 0.5 * over_short
        more = (self.simulated.contacts - self.recorded.contacts) / self.near
        closer = self.simulated.close_share - self.recorded.close_share
        found += _CONTACT * max(0.0, more) + _CLOSE * max(0.0, closer)
        if math.isfinite(self.recorded.first):
            found += _FIRST * abs(self.simulated.first - self.recorded.first)
        return found


class Objective:
    """The objective of parameters of VCI, at some sites.

    Args:
        sites: Recorded people of each site.
        draws: Number of times that people are simulated.
        corridors: Whether the speeds in corridors count.
    """

    def __init__(
        self, sites: Sequence[Yardstick], draws: int = 1, *, corridors: bool = True
    ) -> None:
        self._sites, self._draws, self._corridors = tuple(sites), draws, corridors
        self._config = RunConfig()
        self._weidmann = weidmann()

    def __call__(self, parameters: VciParameters) -> float:
        """Return the value; ``FAILED`` at most."""
        values = [each.value for each in self.likenesses(parameters)]
        value = float(np.mean(values))
        if self._corridors:
            speed = self.speeds(parameters)
            apart = np.abs(np.log(np.maximum(speed, 0.01) / self._weidmann))
            value += _CORRIDOR * float(np.mean(np.maximum(apart - _ALIKE, 0.0)))
        return value if math.isfinite(value) else FAILED

    def likenesses(self, parameters: VciParameters) -> list[Likeness]:
        """Return how like the recorded people of each site the simulated ones are."""
        return [self._likeness(site, parameters) for site in self._sites]

    def speeds(self, parameters: VciParameters) -> np.ndarray:
        """Return the mean speed (D,) [m/s] in corridors of ``DENSITIES``."""
        return walk(CrowdModel(parameters, _STEP), _DURATION).speed

    def _likeness(self, site: Yardstick, parameters: VciParameters) -> Likeness:
        draws = site.simulated(self._config, self._draws, parameters=parameters)
        both = together(draws)
        ratios = site.ratios(both)
        recorded, simulated = site.recorded, counts_of(draws)
        real = counts_of([recorded])
        return Likeness(
            ratios=ratios,
            mean=float(np.mean([ratios[m.name] for m in MEASURES if m.name in ratios])),
            recorded=real,
            simulated=simulated,
            near=site.near,
            hardness=(
                _quotient(simulated.acceleration, real.acceleration),
                _quotient(hardest(both, CHANGE), hardest(recorded, CHANGE)),
            ),
        )


def _quotient(simulated: float, recorded: float) -> float:
    """Return the quotient, or 1 if recorded people near vehicles do not accelerate at all."""
    return simulated / recorded if recorded > 0.0 else 1.0
