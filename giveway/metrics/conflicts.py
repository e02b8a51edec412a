"""The proximity of each pedestrian and the ego, and the number of those below the TTC limit.

The ego is its true rectangle, a pedestrian a circle of ``body_radius``. Both are exact at the
control instants. Lengths are in m, times in s.
"""

from dataclasses import dataclass
from math import cos, inf, nan, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.contact import contact_interval, signed_distance, to_frame
from giveway.geometry.kernel import kernel
from giveway.run_data.tracks import CrowdTrack, EgoTrack

CRITICAL_TTC = 1.5
"""Time to collision [s] below which an encounter is critical: the threshold of SSAM (Gettman &
Head 2003, FHWA), in the range that observers of Hayward's (1972) near misses found."""


class Proximity(NamedTuple):
    """The proximity of pedestrian and ego for each of R crowd records; all are (R,).

    Attributes:
        clearance: Distance [m] between the pedestrian's circle and the ego's rectangle; negative
            where they overlap.
        time_to_collision: Time [s] until the first contact if both kept their velocity: 0 if they
            touch already, inf if they never do. It is the usual surrogate measure (Hayward 1972),
            but the two need not move on one line: the rectangle moves along its heading at its
            present speed, the circle along its present velocity, and the first contact of the two
            shapes is solved exactly. Therefore a pedestrian who walks into the side of a standing
            ego has a finite time to collision, too.
        deceleration: Deceleration to avoid a crash [m/s^2] (DRAC, Cooper & Ferguson 1976): the
            constant braking that just avoids a pedestrian ahead. It is c^2 / (2 d) with the closing
            speed c along the ego's heading and d = c * (time to collision). With this braking, the
            ego has the pedestrian's speed along its heading when it reaches the place of contact.
            It is 0 for a pedestrian who is not on a collision course, is not ahead of the front
            bumper (where braking does not help), or is touched already.
    """

    clearance: NDArray[np.float64]
    time_to_collision: NDArray[np.float64]
    deceleration: NDArray[np.float64]


def proximity(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float
) -> Proximity:
    """Return the proximity of pedestrians and ego for all records, in one pass.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].

    Raises:
        ValueError: a record points outside the ego's track.
    """
    check_records(ego, crowd)
    records = crowd.x.size
    found = Proximity(np.empty(records), np.empty(records), np.empty(records))
    _proximity(
        centre_poses(ego, shape),
        as_floats(ego.speed),
        records_of(crowd, slice(None)),
        contact_body(shape, body_radius),
        found,
    )
    return found


class Records(NamedTuple):
    """The records of a crowd as kernels take them, R rows."""

    step: NDArray[np.int64]  # (R,) control instants
    x: NDArray[np.float64]  # (R,) [m]
    y: NDArray[np.float64]  # (R,) [m]
    vx: NDArray[np.float64]  # (R,) [m/s]
    vy: NDArray[np.float64]  # (R,) [m/s]


def records_of(crowd: CrowdTrack, order: NDArray[np.intp] | slice) -> Records:
    """Return the records of a crowd in an order (R,), in the kernels' layout."""
    columns = (crowd.x, crowd.y, crowd.vx, crowd.vy)
    return Records(as_integers(crowd.step[order]), *(as_floats(each[order]) for each in columns))


@dataclass(frozen=True)
class Critical:
    """The critical encounters of a drive.

    Attributes:
        pedestrians: Number of pedestrians below ``CRITICAL_TTC``.
        share: Share of the control instants with such a pedestrian.
        minimum_ttc: Smallest time to collision [s] with the moving ego; nan without any.
    """

    pedestrians: int
    share: float
    minimum_ttc: float = nan


def critical_encounters(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float, stop_speed: float
) -> Critical:
    """Count the pedestrians with a time to collision below ``CRITICAL_TTC`` while the ego moves.

    A pedestrian who walks up to a standing ego is on a collision course, too, but in no danger.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        stop_speed: Speed [m/s] above which the ego moves.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    pedestrians, soonest, instants = 0, inf, np.zeros(ego.time.size, dtype=np.bool_)
    for part in crowd.by_people():
        ttc = proximity(ego, part, shape, body_radius).time_to_collision
        moving = ego.speed[part.step] > stop_speed
        critical = (ttc < CRITICAL_TTC) & moving
        soonest = float(ttc[moving].min(initial=soonest))
        instants[part.step[critical]] = True
        pedestrians += np.unique(part.pedestrian[critical]).size
    return Critical(
        pedestrians=pedestrians,
        share=int(instants.sum()) / ego.time.size if ego.time.size else 0.0,
        minimum_ttc=soonest if soonest < inf else nan,
    )


def contact_body(shape: VehicleShape, body_radius: float) -> tuple[float, float, float]:
    """Return the sizes that decide on a contact: half length, half width, radius [m]."""
    return shape.length / 2.0, shape.width / 2.0, float(body_radius)


def centre_poses(ego: EgoTrack, shape: VehicleShape) -> NDArray[np.float64]:
    """Return the centre and heading of the rectangle at every instant: x, y, cos, sin (T, 4)."""
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
    """Return the column in the kernels' memory layout; it is copied only if needed."""
    return np.ascontiguousarray(column, dtype=np.float64)


def as_integers(column: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return the column in the kernels' memory layout; it is copied only if needed."""
    return np.ascontiguousarray(column, dtype=np.int64)


def check_records(ego: EgoTrack, crowd: CrowdTrack) -> None:
    """Refuse records that point at instants or pedestrians that do not exist.

    Raises:
        ValueError: a record is out of range; the message names column, value and range.
    """
    for part in crowd.pieces():
        _check_records(ego, part)


def _check_records(ego: EgoTrack, crowd: CrowdTrack) -> None:
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
    records: Records,
    body: tuple[float, float, float],
    out: Proximity,
) -> None:
    step, x, y, vx, vy = records
    half_length, half_width, radius = body
    out_clearance, out_ttc, out_drac = out
    for r in range(step.size):
        k = step[r]
        c, s = poses[k, 2], poses[k, 3]
        p_x, p_y = to_frame(x[r] - poses[k, 0], y[r] - poses[k, 1], c, s)
        w_x, w_y = to_frame(vx[r], vy[r], c, s)
        w_x -= speed[k]
        out_clearance[r] = signed_distance(p_x, p_y, half_length, half_width) - radius
        first, last = contact_interval(p_x, p_y, w_x, w_y, *body)
        out_ttc[r] = max(first, 0.0) if last >= 0.0 else inf
        avoidable = out_clearance[r] > 0.0 and 0.0 < out_ttc[r] < inf
        ahead = p_x > half_length and w_x < 0.0
        out_drac[r] = -w_x / (2.0 * out_ttc[r]) if avoidable and ahead else 0.0
