"""Serious conflicts of the ego with people, after the Swedish traffic conflict technique.

Hydén (1987) rates a conflict by two numbers of the instant at which the evasion begins: the time to
accident, which is the time to collision then, and the conflicting speed, which is the speed of who
evades. A conflict is serious if the time to accident is shorter than the border for this speed.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import STANDING
from giveway.metrics.conflicts import Proximity
from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.tracks import CrowdTrack, EgoTrack

EVASION = 3.0
"""Deceleration [m/s^2] above which the ego brakes in order to evade."""
# Border of serious conflicts (Hydén 1987, as quoted by others; see docs/encounters.md): 1.5 times
# the time that the shortest braking distance takes at the conflicting speed.
_MARGIN = 1.5
_TWICE_BRAKING = 16.7  # Twice the hardest braking [m/s^2] from low speed: 2 g times friction 0.85
_FADING = 0.0306  # Relative loss of friction [s/m] per mean speed of the braking


class SeriousConflicts(NamedTuple):
    """The most severe instant of each pedestrian (n,); nan without a collision course.

    Attributes:
        time_to_accident: Time to collision [s] then; 0 for a contact.
        conflicting_speed: Speed [m/s] then of the ego, or of a pedestrian beside it.
    """

    time_to_accident: NDArray[np.float64]
    conflicting_speed: NDArray[np.float64]


def border(speed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the time to accident [s] below which a conflict at a speed [m/s] is serious."""
    # The C library's exp: numpy's has other last digits on processors without AVX-512.
    fading = np.fromiter(map(math.exp, -_FADING * speed / 2.0), float, len(speed))
    return np.asarray(_MARGIN * speed / (_TWICE_BRAKING * fading))


def serious(found: SeriousConflicts) -> NDArray[np.bool_]:
    """Return which pedestrians (n,) had a serious conflict or a contact with the moving ego."""
    return np.asarray(found.time_to_accident < border(found.conflicting_speed), dtype=np.bool_)


def serious_conflicts(
    ego: EgoTrack, crowd: CrowdTrack, groups: PedestrianGroups, near: Proximity
) -> SeriousConflicts:
    """Return time to accident and conflicting speed at each pedestrian's most severe instant.

    It is the instant with the smallest ratio of the time to collision to the border. Instants count
    until the ego evades, that is, brakes harder than ``EVASION``, and again when it has ended that.
    A contact always counts. The ego evades people ahead of its front bumper. Braking does not help
    those beside it: they evade themselves, so that their own speed is the conflicting speed.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians.
        groups: The crowd's records by pedestrian.
        near: Proximity of the records.
    """
    ttc = near.time_to_collision
    braking = ego.acceleration < -EVASION
    evades = braking & np.append(False, braking[:-1])
    contact = ttc <= 0.0
    counts = contact | (np.isfinite(ttc) & ~evades[crowd.step])
    counts &= ego.speed[crowd.step] > STANDING
    by_ego = contact | (near.deceleration > 0.0)
    speed = np.where(by_ego, ego.speed[crowd.step], np.hypot(crowd.vx, crowd.vy))
    ratio = np.full(ttc.size, np.inf)
    counts &= speed > 0.0
    ratio[counts] = ttc[counts] / border(speed[counts])
    worst = groups.first_minimum(ratio)
    some = np.isfinite(groups.at(ratio, worst))
    return SeriousConflicts(
        np.where(some, groups.at(ttc, worst), np.nan),
        np.where(some, groups.at(speed, worst), np.nan),
    )
