"""Post-encroachment time: the time by which ego and pedestrian missed each other."""

from math import inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
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
from giveway.metrics.separation import EgoMotion, blocks_of, ego_comes_later, separation
from giveway.run_data.tracks import CrowdTrack, EgoTrack

SECTIONS = 16  # Number of parts of a control period in which the smallest separation is searched
GOLDEN = 0.6180339887498949


PERSON, EGO, CONTACT = "person", "ego", "contact"
"""The road user that was first at the common place; ``CONTACT`` if they were there together."""
_WHO = np.array(["", PERSON, EGO, CONTACT])
_NEVER, _PERSON, _EGO, _CONTACT = range(4)


class Encroachment(NamedTuple):
    """The post-encroachment times of the ego and n pedestrians.

    Attributes:
        time: Post-encroachment time (n,) [s]; nan where the paths never cross.
        first: Road user (n,) that was first: ``PERSON``, ``EGO`` or ``CONTACT``; empty if the paths
            never cross.
    """

    time: NDArray[np.float64]
    first: NDArray[np.str_]


def encroachment(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    clock: NDArray[np.float64] | None = None,
) -> Encroachment:
    """Find the smallest time between the pedestrian's and the ego's presence at one place.

    Allen, Shin & Cooper (1978) measure from the instant at which the first road user leaves the
    conflict area until the second one enters it. SSAM (Gettman & Head 2003, FHWA) takes the
    smallest such time over the places that both occupy. This function follows SSAM, with true
    shapes in place of a conflict area that must be drawn by hand. A pedestrian's body is at a place
    at time t, and the ego's rectangle touches that body's circle there during [t_in, t_out]. The
    two are max(t_in - t, t - t_out, 0) apart, and the smallest value over all t counts. The ego's
    own poses are searched, so that the result holds on any curved path and in either order. The
    largest of the three terms says who came first.
    The instant within a control period is found to less than a thousandth of it.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        clock: Control instants (K,) [s] to which the crowd's records belong, the first T of them
            the ego's. None if they are the ego's.

    Returns:
        The times and who was first. A time is 0 for a collision, and nan where the paths never
        cross. It is also nan if the ego's track ends before it reaches the place.

    Raises:
        ValueError: a record points outside the control instants.
    """
    if clock is None:
        check_records(ego, crowd)
    groups = PedestrianGroups(crowd)
    times, first = _smallest_separations(
        as_floats(ego.time if clock is None else clock),
        as_floats(ego.time),
        centre_poses(ego, shape),
        as_integers(groups.bounds),
        records_of(crowd, groups.order),
        contact_body(shape, body_radius),
    )
    return Encroachment(times, _WHO[first])


class _Leg(NamedTuple):
    """The walk of a pedestrian in one step."""

    k: int  # index of the step
    begin: float  # [s]
    duration: float  # [s]
    x: tuple[float, float]  # [m] at its begin and end
    y: tuple[float, float]  # [m]


@inner
def _separation_on_the_way(share: float, leg: _Leg, cutoff: float, ego: EgoMotion) -> float:
    """Return the separation after a ``share`` of a leg."""
    x, y = leg.x, leg.y
    at_x, at_y = x[0] + share * (x[1] - x[0]), y[0] + share * (y[1] - y[0])
    return separation(leg.begin + share * leg.duration, at_x, at_y, leg.k, cutoff, ego)


@inner
def _smallest_between(leg: _Leg, leaving: bool, cutoff: float, ego: EgoMotion) -> float:
    """Find the smallest separation during a leg.

    Golden section: a separation has one minimum in a step, at or shortly before the edge of the
    swept strip if the walk crosses it, because the ego's corners are rounded. Beyond the edge it
    is inf; ``leaving`` says on which side of the edge to look while both trials are beyond.
    """
    smallest = inf
    low, high = 0.0, 1.0
    for _ in range(SECTIONS):
        early, late = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        at_early = _separation_on_the_way(early, leg, cutoff, ego)
        at_late = _separation_on_the_way(late, leg, cutoff, ego)
        smallest = min(smallest, at_early, at_late)
        if at_early < at_late or (at_early == at_late and leaving):
            high = late
        else:
            low = early
    return smallest


@inner
def _share_inside(leg: _Leg, ego: EgoMotion) -> float:
    """Return the share of a leg after which the pedestrian is first found in the strip, or 0."""
    for section in range(1, 4 * SECTIONS):
        share = section / (4.0 * SECTIONS)
        if _separation_on_the_way(share, leg, inf, ego) < inf:
            return share
    return 0.0


@kernel
def _smallest_separations(
    clock: NDArray[np.float64],
    time: NDArray[np.float64],
    poses: NDArray[np.float64],
    bounds: NDArray[np.int64],
    records: Records,
    body: tuple[float, float, float],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the post-encroachment times, and who was first.

    Pedestrian i has the records bounds[i] to bounds[i + 1].
    """
    step, x, y, _, _ = records
    ego = EgoMotion(time, poses, blocks_of(poses, *body), body)
    at_record = np.empty(x.size)
    pets = np.full(bounds.size - 1, nan)
    who = np.full(bounds.size - 1, _NEVER)
    for i in range(pets.size):
        nearest = inf
        t, at_x, at_y, at, reach = 0.0, 0.0, 0.0, 0, inf  # those of the record before
        for r in range(bounds[i], bounds[i + 1]):
            k = step[r]
            # Within a period a separation shrinks by less than a period. A value beyond the cutoff
            # therefore cannot lead to the smallest one.
            period = clock[k] - clock[max(k - 1, 0)]
            cutoff = nearest + 2.0 * period
            at_record[r] = separation(clock[k], x[r], y[r], k, cutoff, ego)
            if at_record[r] < nearest:
                nearest = reach = at_record[r]
                t, at_x, at_y, at = clock[k], x[r], y[r], k
        for r in range(bounds[i] + 1, bounds[i + 1]):
            k = step[r - 1]
            period = clock[step[r]] - clock[k]
            ends = at_record[r - 1], at_record[r]
            if step[r] == k + 1 and min(ends) - period < nearest and nearest > 0.0:
                leg = _Leg(k, clock[k], period, (x[r - 1], x[r]), (y[r - 1], y[r]))
                cutoff = nearest + 2.0 * period
                between = _smallest_between(leg, ends[0] < ends[1], cutoff, ego)
                if reach == inf and between < nearest:  # the strip was crossed between two records
                    share = _share_inside(leg, ego)
                    t, at = clock[k] + share * period, k
                    at_x = x[r - 1] + share * (x[r] - x[r - 1])
                    at_y = y[r - 1] + share * (y[r] - y[r - 1])
                nearest = min(nearest, between)
        if nearest == inf:
            continue
        pets[i] = nearest
        if nearest <= 0.0:
            who[i] = _CONTACT
        else:
            later = ego_comes_later(t, at_x, at_y, at, reach + 1e-9, ego)
            who[i] = _PERSON if later else _EGO
    return pets, who
