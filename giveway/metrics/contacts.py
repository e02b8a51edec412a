"""The kinds of contact between ego and pedestrian: frontal or lateral.

The ego is responsible for pedestrians that it drives into, not for those who walk into its side or
into the standing ego. The rule and its rare cases are in docs/results.md.
"""

from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.contact import contact_interval, to_frame
from giveway.geometry.kernel import inner, kernel
from giveway.metrics.conflicts import (
    Records,
    as_floats,
    as_integers,
    centre_poses,
    check_records,
    contact_body,
    records_of,
)
from giveway.metrics.groups import PedestrianGroups
from giveway.run_data.tracks import CrowdTrack, EgoTrack

NO_CONTACT = ""
RECORDED = "recorded"
"""Kind of the contact of a person who walked as recorded, and did not react to the ego."""
SIDE = "side"
FRONTAL = "frontal"
MOVING = 0.01
"""Speed [m/s] above which the ego moves; no controller creeps at a centimetre per second."""

_NAMES = np.array([NO_CONTACT, SIDE, FRONTAL, RECORDED])
_SIDE, _FRONTAL, _RECORDED = 1, 2, 3


def contacts(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    clearance: NDArray[np.float64],
) -> NDArray[np.str_]:
    """Return the kind of contact of each pedestrian with the ego, as in :func:`impacts`."""
    return impacts(ego, crowd, shape, body_radius, clearance)[0]


def impacts(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    clearance: NDArray[np.float64],
) -> tuple[NDArray[np.str_], NDArray[np.float64]]:
    """Return the kind of contact of each pedestrian with the ego, if there was one, and its speed.

    A contact is frontal if at its first instant the pedestrian's centre is ahead of the front
    bumper's line and the ego moves. It is also frontal if both hold later on while the ego is the
    faster one along its heading: then it moves into a person who stands at its front. All others
    are ``side``. The first instant is found between control instants, with straight motion between
    them.

    A person who touches the ego while walking as recorded has a contact of the kind ``recorded``,
    whatever follows. It says nothing about the ego alone, since the person could not give way.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians in time order.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        clearance: Clearance (R,) [m] of :func:`giveway.metrics.proximity`; below zero is a contact.

    Returns:
        Kind (n,): ``recorded``, or ``frontal`` after any frontal contact, otherwise ``side``, or
            empty without a contact.
        Speed (n,) [m/s] of the impact: of the ego at its first frontal contact, or of ego and
            pedestrian relative to each other at the first contact at a side; nan without a contact.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    check_records(ego, crowd)
    groups = PedestrianGroups(crowd)
    kinds = np.zeros(len(crowd.ids), dtype=np.int64)
    speeds = np.full(len(crowd.ids), np.nan)
    _classify(
        centre_poses(ego, shape),
        as_floats(ego.speed),
        as_integers(groups.bounds),
        records_of(crowd, groups.order),
        as_floats(clearance[groups.order]),
        contact_body(shape, body_radius),
        kinds,
        speeds,
    )
    if crowd.reacts_from is not None:
        unaware = crowd.step < crowd.reacts_from[crowd.pedestrian]
        kinds[crowd.pedestrian[unaware & (clearance < 0.0)]] = _RECORDED
    return np.asarray(_NAMES[kinds], dtype=np.str_), speeds


@inner
def _first_touch(
    k: int,
    r: int,
    poses: NDArray[np.float64],
    speed: NDArray[np.float64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    body: tuple[float, float, float],
) -> tuple[float, float]:
    """Return the place and the ego's speed at the contact that begins in the step before k.

    The place [m] is the pedestrian's centre in the ego's frame.
    """
    b, e = poses[k - 1], poses[k]
    b_x, b_y = to_frame(x[r - 1] - b[0], y[r - 1] - b[1], b[2], b[3])
    e_x, e_y = to_frame(x[r] - e[0], y[r] - e[1], e[2], e[3])
    first, _ = contact_interval(b_x, b_y, e_x - b_x, e_y - b_y, *body)
    share = min(max(first, 0.0), 1.0) if first < inf else 1.0
    return b_x + share * (e_x - b_x), speed[k - 1] + share * (speed[k] - speed[k - 1])


@kernel
def _classify(
    poses: NDArray[np.float64],
    speed: NDArray[np.float64],
    bounds: NDArray[np.int64],
    records: Records,
    clearance: NDArray[np.float64],
    body: tuple[float, float, float],
    kinds: NDArray[np.int64],
    speeds: NDArray[np.float64],
) -> None:
    """Fill ``kinds`` and ``speeds`` (n,).

    The records must be sorted by pedestrian, and then by time.
    """
    step, x, y, vx, vy = records
    half_length, _, _ = body
    for i in range(kinds.size):
        for r in range(bounds[i], bounds[i + 1]):
            if clearance[r] >= 0.0:
                continue
            k = step[r]
            c, s = poses[k, 2], poses[k, 3]
            p_x, _ = to_frame(x[r] - poses[k, 0], y[r] - poses[k, 1], c, s)
            w_x, w_y = to_frame(vx[r], vy[r], c, s)
            frontal = p_x > half_length and speed[k] > MOVING and speed[k] > w_x
            impact = speed[k]
            followed = r > bounds[i] and step[r - 1] == k - 1
            if followed and clearance[r - 1] >= 0.0:
                at, impact = _first_touch(k, r, poses, speed, x, y, body)
                frontal = frontal or (at > half_length and impact > MOVING)
            elif not followed:
                frontal = frontal or (p_x > half_length and speed[k] > MOVING)
            if frontal and kinds[i] != _FRONTAL:
                kinds[i], speeds[i] = _FRONTAL, impact
            elif kinds[i] == 0:
                kinds[i], speeds[i] = _SIDE, hypot(impact - w_x, w_y)
