"""Kinds of people: how fast each of them would like to walk.

* ``adult``: as ``[crowd]`` says, by default as recorded in Yang & Özgüner 2019.
* ``elderly``: 3.81 ft/s, 15th percentile 3.02 ft/s, at crossings (Gates, Noyce, Bill & Van Ee,
  "Recommended walking speeds for timing of pedestrian clearance intervals based on characteristics
  of the pedestrian population", Transportation Research Record 1982, 2006: 326 people over 65).
* ``child``: with an adult, who cross as fast as the elderly (the same).
* ``distracted``: who writes on a phone takes 18 % longer (Thompson, Rivara, Ayyagari & Ebel,
  "Impact of social and technological distraction on pedestrian crossing behaviour", Injury
  Prevention 19, 2013). Late to notice vehicles, too: attention.py.
* ``hurried``: 1.61 m/s, who walk on business (Weidmann, "Transporttechnik der Fussgänger",
  Schriftenreihe des IVT 90, 1993; cited from memory), scattered as adults are.
"""

from collections.abc import Sequence

import numpy as np

from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import ADULT, PeopleConfig
from giveway.geometry.kernel import Array

_FOOT = 0.3048  # [m]
_SLOW = 3.81 * _FOOT, (3.81 - 3.02) * _FOOT / 1.0364  # mean, deviation: 15 % are 1.0364 below
_PHONE = 1.18
_BUSINESS = 1.61  # [m/s]
_REDRAWS = 1_000


def draw_kinds(people: PeopleConfig, count: int, random: np.random.Generator) -> tuple[str, ...]:
    """Draw the kinds of ``count`` people; without a mixture all are empty and undrawn."""
    if not people.mixed:
        return ("",) * count
    shares = people.shares
    names = [*shares, ADULT]
    chances = np.array([*shares.values(), max(0.0, 1.0 - sum(shares.values()))])
    return tuple(names[i] for i in random.choice(len(names), count, p=chances / chances.sum()))


def desired_speeds(config: CrowdConfig, kinds: Sequence[str], random: np.random.Generator) -> Array:
    """Draw desired speeds (n,) [m/s] by kind: normal, redrawn until they lie in the bounds.

    Args:
        config: Distribution for adults, and the bounds for all.
        kinds: (n,) Kind of each person; empty counts as adult.
        random: Generator of the draws.
    """
    low, high = config.desired_speed_min, config.desired_speed_max
    about = [_distribution(config, kind) for kind in kinds]
    mean, deviation = np.array(about, dtype=np.float64).reshape(-1, 2).T
    speeds = random.normal(mean, deviation)
    for _ in range(_REDRAWS):
        outside = (speeds < low) | (speeds > high)
        if not outside.any():
            return speeds
        speeds[outside] = random.normal(mean[outside], deviation[outside])
    return np.clip(speeds, low, high)  # bounds so narrow that hardly any draw falls between them


def _distribution(config: CrowdConfig, kind: str) -> tuple[float, float]:
    """Return mean and standard deviation of the desired speed [m/s]."""
    mean, deviation = config.desired_speed_mean, config.desired_speed_sd
    known = {
        "child": _SLOW,
        "elderly": _SLOW,
        "distracted": (mean / _PHONE, deviation / _PHONE),
        "hurried": (_BUSINESS, deviation),
    }
    return known.get(kind, (mean, deviation))
