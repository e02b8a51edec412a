"""Draws kinds of people, and their desired speeds by kind.

* ``adult``: the speeds of ``[crowd]``, by default those recorded in Yang & Özgüner 2019.
* ``elderly``: mean 3.81 ft/s, 15th percentile 3.02 ft/s, at crossings (Gates, Noyce, Bill & Van Ee,
  "Recommended walking speeds for timing of pedestrian clearance intervals based on characteristics
  of the pedestrian population", Transportation Research Record 1982, 2006: 326 people over 65).
* ``child``: a child with an adult, as fast as the elderly (same source).
* ``distracted``: a person who writes on a phone needs 18 % more time (Thompson, Rivara, Ayyagari &
  Ebel, "Impact of social and technological distraction on pedestrian crossing behaviour", Injury
  Prevention 19, 2013), and notices vehicles late: attention.py.
* ``hurried``: mean 1.61 m/s, for people on business (Weidmann, "Transporttechnik der Fussgänger",
  Schriftenreihe des IVT 90, 1993; cited from memory), with the standard deviation of adults.
"""

from collections.abc import Sequence

import numpy as np

from giveway.config.tables.crowd import CrowdConfig
from giveway.config.tables.people import ADULT, PeopleConfig
from giveway.geometry.kernel import Array

_FOOT = 0.3048  # length [m] of a foot
# Mean and standard deviation [m/s]; the 15th percentile is 1.0364 deviations below the mean.
_SLOW = 3.81 * _FOOT, (3.81 - 3.02) * _FOOT / 1.0364
_PHONE = 1.18  # factor on the walking time of a person who writes on a phone
_BUSINESS = 1.61  # mean speed [m/s] of people on business
_REDRAWS = 1_000  # largest number of draws


def draw_kinds(people: PeopleConfig, count: int, random: np.random.Generator) -> tuple[str, ...]:
    """Draw the kinds of ``count`` people.

    Without a mixture all kinds are empty, and no random number is drawn.
    """
    if not people.mixed:
        return ("",) * count
    shares = people.shares
    names = [*shares, ADULT]
    chances = np.array([*shares.values(), max(0.0, 1.0 - sum(shares.values()))])
    return tuple(names[i] for i in random.choice(len(names), count, p=chances / chances.sum()))


def desired_speeds(config: CrowdConfig, kinds: Sequence[str], random: np.random.Generator) -> Array:
    """Draw desired speeds (n,) [m/s] by kind: normal, drawn again until they are in the bounds.

    Args:
        config: Distribution for adults.
        kinds: Kind (n,) of each person; empty counts as adult.
        random: Generator of the draws.
    """
    low, high = config.desired_speed_bounds
    mean, deviation = _distributions(config, kinds)
    speeds: Array = random.normal(mean, deviation)
    for _ in range(_REDRAWS):
        outside = (speeds < low) | (speeds > high)
        if not outside.any():
            return speeds
        speeds[outside] = random.normal(mean[outside], deviation[outside])
    # for bounds so narrow that hardly any draw is within
    return np.asarray(np.clip(speeds, low, high))


def speeds_at(config: CrowdConfig, kinds: Sequence[str], draws: Array) -> Array:
    """Return the desired speeds (n,) [m/s] of standard normal numbers (n,).

    They have the distribution of :func:`desired_speeds`.

    Args:
        config: Distribution for adults.
        kinds: Kind (n,) of each person; empty counts as adult.
        draws: Standard normal number of each person.
    """
    from scipy.special import ndtr, ndtri

    low, high = config.desired_speed_bounds
    mean, deviation = _distributions(config, kinds)
    spread = np.maximum(deviation, 1e-9)  # a deviation of 0 gives the mean
    least, most = ndtr((low - mean) / spread), ndtr((high - mean) / spread)
    speeds = mean + spread * ndtri(least + ndtr(draws) * (most - least))
    return np.asarray(np.clip(speeds, low, high))


def _distributions(config: CrowdConfig, kinds: Sequence[str]) -> Array:
    """Return means and standard deviations (2, n) of desired speeds [m/s]."""
    about = [_distribution(config, kind) for kind in kinds]
    columns: Array = np.array(about, dtype=np.float64).reshape(-1, 2).T
    return columns


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
