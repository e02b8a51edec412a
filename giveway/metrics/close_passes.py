"""The clearance at which a vehicle passes each person, by its speed, and which passes are close.

A vehicle is its rectangle and a person a circle. A clearance is that of one instant, on any side.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NEAR = 4.0
"""Clearance [m] up to which a person is near a vehicle."""
MOVING_SPEED = 0.5
"""Speed [m/s] above which a vehicle passes people, and they do not pass it."""
CLOSE, CLOSE_SPEED = 0.5, 2.0
"""Clearance [m] below which, at more than this speed [m/s], a vehicle passes a person closely: as
the drivers of the data set DUT (Yang et al. 2019) passed 2.2 % of the 507 people near them."""
TIGHT, TIGHT_SPEED = 0.3, 3.0
"""Clearance [m] and speed [m/s] of a pass that is closer and faster still."""
NARROW_SPEED = 1.0
"""Speed [m/s] above which a pass is too fast for a clearance below ``TIGHT``."""


class Clearances(NamedTuple):
    """The smallest clearance [m] of each person (n,), above each speed; nan without a row.

    Attributes:
        least: Clearance at any speed.
        moving: Clearance above ``MOVING_SPEED``.
        above_1, above_2, above_3: Clearance above ``NARROW_SPEED``, ``CLOSE_SPEED`` and
            ``TIGHT_SPEED``.
    """

    least: NDArray[np.float64]
    moving: NDArray[np.float64]
    above_1: NDArray[np.float64]
    above_2: NDArray[np.float64]
    above_3: NDArray[np.float64]


class Passes(NamedTuple):
    """The people near a vehicle, and those whom it passes closely; masks (n,).

    Attributes:
        near: People within ``NEAR`` at some instant.
        near_moving: People within ``NEAR`` while the vehicle is faster than ``MOVING_SPEED``.
        close: People closer than ``CLOSE`` above ``CLOSE_SPEED``.
        tight: People closer than ``TIGHT`` above ``TIGHT_SPEED``.
        narrow: People closer than ``TIGHT`` above ``NARROW_SPEED``.
    """

    near: NDArray[np.bool_]
    near_moving: NDArray[np.bool_]
    close: NDArray[np.bool_]
    tight: NDArray[np.bool_]
    narrow: NDArray[np.bool_]


def clearances(
    person: NDArray[np.int64],
    speed: NDArray[np.float64],
    clearance: NDArray[np.float64],
    people: int,
) -> Clearances:
    """Return the smallest clearances of each person above each speed.

    Args:
        person: Index (R,) of each row's person.
        speed: Speed (R,) [m/s] of the vehicle.
        clearance: Distance (R,) [m] from outline to outline; negative where they overlap.
        people: Number n of people.
    """
    found = np.full((len(Clearances._fields), people), np.inf)
    above = (-np.inf, MOVING_SPEED, NARROW_SPEED, CLOSE_SPEED, TIGHT_SPEED)
    for smallest, least in zip(found, above, strict=True):
        fast = speed > least
        np.minimum.at(smallest, person[fast], clearance[fast])
    return Clearances(*np.where(np.isfinite(found), found, np.nan))


def passes(found: Clearances) -> Passes:
    """Return who is near a vehicle, and whom it passes closely; nan counts as no clearance."""
    return Passes(
        near=found.least <= NEAR,
        near_moving=found.moving <= NEAR,
        close=found.above_2 < CLOSE,
        tight=found.above_3 < TIGHT,
        narrow=found.above_1 < TIGHT,
    )
