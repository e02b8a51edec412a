"""How close every pedestrian and the ego came, record by record.

The ego is its true rectangle, a pedestrian a circle of ``body_radius``; both are exact at the
control instants. Lengths in m, times in s.
"""

from __future__ import annotations

from math import cos, inf, sin
from typing import TYPE_CHECKING

import numpy as np

from giveway.geometry.contact import contact_interval, signed_distance, to_frame
from giveway.geometry.kernel import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.geometry.bodies import VehicleShape
    from giveway.records.tracks import CrowdTrack, EgoTrack


def clearance(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> NDArray[np.float64]:
    """Distance between the pedestrian's skin and the ego's bodywork, for every crowd record.

    Args:
        ego: the ego's track, T instants.
        crowd: the crowd's track, R records.
        shape: the ego's rectangle.
        body_radius: radius of a pedestrian [m].

    Returns:
        (R,) [m], negative where the circle overlaps the rectangle.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    return proximity(ego, crowd, shape, body_radius)[0]


def time_to_collision(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> NDArray[np.float64]:
    """Time until first contact if both kept their velocity, for every crowd record.

    The usual surrogate (Hayward 1972) without its usual shortcut of one line of travel: the
    rectangle moves along its heading at its present speed, the circle along its present velocity,
    and the first contact of the two shapes is solved exactly. A pedestrian walking into the side
    of a standing ego therefore has a finite time to collision too.

    Returns:
        (R,) [s]: 0 when touching already, inf when never on these courses.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    return proximity(ego, crowd, shape, body_radius)[1]


def deceleration_to_avoid_crash(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> NDArray[np.float64]:
    """The constant braking that would just spare a pedestrian ahead, for every crowd record.

    DRAC (Cooper & Ferguson 1976) is c^2 / (2 d) with the closing speed c and the distance d to be
    closed. Here c is along the ego's heading and d = c * (time to collision): braking by it, the
    ego has matched the pedestrian's speed along its heading when it reaches the place of contact.

    Returns:
        (R,) [m/s^2]: 0 for whoever is not on a collision course, is not ahead of the front
        bumper (braking is no remedy there), or is touched already (no braking helps any more).

    Raises:
        ValueError: a record points outside the ego's track.
    """
    return proximity(ego, crowd, shape, body_radius)[2]


def proximity(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Clearance, time to collision and DRAC of every record, in one pass; shapes (R,)."""
    check_records(ego, crowd)
    records = crowd.x.size
    clearances, ttcs, dracs = np.empty(records), np.empty(records), np.empty(records)
    _proximity(
        centre_poses(ego, shape),
        as_floats(ego.speed),
        as_integers(crowd.step),
        as_floats(crowd.x),
        as_floats(crowd.y),
        as_floats(crowd.vx),
        as_floats(crowd.vy),
        shape.length / 2.0,
        shape.width / 2.0,
        float(body_radius),
        clearances,
        ttcs,
        dracs,
    )
    return clearances, ttcs, dracs


def centre_poses(ego: EgoTrack, shape: VehicleShape) -> NDArray[np.float64]:
    """The rectangle's centre and heading at every instant: (T, 4) rows of x, y, cos, sin."""
    poses = np.empty((ego.time.size, 4))
    _centre_poses(
        as_floats(ego.front_x),
        as_floats(ego.front_y),
        as_floats(ego.heading),
        shape.length / 2.0,
        poses,
    )
    return poses


def as_floats(column: NDArray[np.floating]) -> NDArray[np.float64]:
    """The column as the kernels are compiled for; a copy only if it is laid out otherwise."""
    return np.ascontiguousarray(column, dtype=np.float64)


def as_integers(column: NDArray[np.integer]) -> NDArray[np.int64]:
    """The column as the kernels are compiled for; a copy only if it is laid out otherwise."""
    return np.ascontiguousarray(column, dtype=np.int64)


def check_records(ego: EgoTrack, crowd: CrowdTrack) -> None:
    """Refuse records that point at instants or pedestrians that do not exist.

    Raises:
        ValueError: naming the column, the value and the range it must lie in.
    """
    limits = (("step", crowd.step, ego.time.size), ("pedestrian", crowd.pedestrian, len(crowd.ids)))
    for name, column, count in limits:
        wrong = column[(column < 0) | (column >= count)]
        if wrong.size:
            raise ValueError(
                f"crowd track: {name} {wrong[0]} is outside 0..{count - 1}; "
                "pass the ego's and the crowd's track of the same run"
            )


@kernel
def _centre_poses(
    front_x: NDArray[np.float64],
    front_y: NDArray[np.float64],
    heading: NDArray[np.float64],
    half_length: float,
    poses: NDArray[np.float64],
) -> None:
    for k in range(front_x.size):
        c, s = cos(heading[k]), sin(heading[k])
        poses[k, 0] = front_x[k] - half_length * c
        poses[k, 1] = front_y[k] - half_length * s
        poses[k, 2] = c
        poses[k, 3] = s


@kernel
def _proximity(
    poses: NDArray[np.float64],
    speed: NDArray[np.float64],
    step: NDArray[np.int64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    vx: NDArray[np.float64],
    vy: NDArray[np.float64],
    half_length: float,
    half_width: float,
    radius: float,
    out_clearance: NDArray[np.float64],
    out_ttc: NDArray[np.float64],
    out_drac: NDArray[np.float64],
) -> None:
    for r in range(step.size):
        k = step[r]
        c, s = poses[k, 2], poses[k, 3]
        p_x, p_y = to_frame(x[r] - poses[k, 0], y[r] - poses[k, 1], c, s)
        w_x, w_y = to_frame(vx[r], vy[r], c, s)
        w_x -= speed[k]
        out_clearance[r] = signed_distance(p_x, p_y, half_length, half_width) - radius
        first, last = contact_interval(p_x, p_y, w_x, w_y, half_length, half_width, radius)
        out_ttc[r] = max(first, 0.0) if last >= 0.0 else inf
        avoidable = out_clearance[r] > 0.0 and 0.0 < out_ttc[r] < inf
        ahead = p_x > half_length and w_x < 0.0
        out_drac[r] = -w_x / (2.0 * out_ttc[r]) if avoidable and ahead else 0.0
