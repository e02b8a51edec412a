"""Anticipation: how early an ego slowed for people, and how long it stood among them.

An attentive driver slows while the first person is still several seconds away, and stops before a
stream of people or flows through it. Lengths are in m, times in s.
"""

from dataclasses import fields
from math import inf, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.bodies import VehicleShape
from giveway.metrics.conflicts import centre_poses, check_records, proximity
from giveway.metrics.groups import PedestrianGroups
from giveway.metrics.slowing import slowing_begins
from giveway.metrics.standing import stops
from giveway.run_data.tracks import CrowdTrack, EgoTrack

PASSING = 5.0
"""Distance [m] from the front or rear bumper within which a person who crosses the ego's line walks
round the car."""


class Anticipation(NamedTuple):
    """The anticipation of an ego.

    Attributes:
        ttc_at_slowing: Time [s] to the first person at the beginning of slowing, at constant speed;
            nan if the ego never slowed, or would have reached nobody.
        time_among_people: Time [s] at standstill with people passing in front of and behind it.
    """

    ttc_at_slowing: float = nan
    time_among_people: float = 0.0


def anticipation(
    ego: EgoTrack,
    crowd: CrowdTrack,
    shape: VehicleShape,
    body_radius: float,
    *,
    reference_speed: float | None,
    stop_speed: float,
) -> Anticipation:
    """Return how early an ego slowed for people, and how long it stood among them.

    Args:
        ego: Track of the ego, T instants.
        crowd: Track of the crowd, R records of n pedestrians in time order.
        shape: Rectangle of the ego.
        body_radius: Radius of a pedestrian [m].
        reference_speed: Reference speed v_r [m/s], or None if the lanes' limits count.
        stop_speed: Speed [m/s] below which the ego stands.

    Raises:
        ValueError: a record points outside the ego's track.
    """
    check_records(ego, crowd)
    begin = slowing_begins(ego, reference_speed)
    ahead = nan
    if begin is not None and ego.speed[begin] >= stop_speed:
        ahead = _time_to_contact(ego, crowd, shape, body_radius, begin)
    return Anticipation(ahead, _among(ego, crowd, shape, stop_speed))


def _time_to_contact(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, body_radius: float, begin: int
) -> float:
    """Return the time [s] from an instant until a contact at constant speed of the ego.

    This is the time to collision at the onset of braking (van der Horst 1990), but with the ego's
    path and the people's walks as they were, instead of straight lines.
    """
    time, way = ego.time[begin:], np.maximum.accumulate(ego.position)
    station = way[begin] + ego.speed[begin] * (time - time[0])
    # nobody was recorded beyond the way
    count = int(np.searchsorted(station, way[-1], side="right"))

    def there(column: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(np.interp(station[:count], way, column), dtype=np.float64)

    taken = {each.name: getattr(ego, each.name)[begin : begin + count] for each in fields(ego)}
    taken |= {
        "front_x": there(ego.front_x),
        "front_y": there(ego.front_y),
        "heading": there(np.unwrap(ego.heading)),
    }
    kept = EgoTrack(**taken)
    contacts = [(inf, nan)]  # control instant and time [s] of the first ones
    for people in crowd.during(begin, count).by_people():
        apart = proximity(kept, people, shape, body_radius).clearance
        touching = np.flatnonzero(apart < 0.0)
        now = touching[people.step[touching] == people.step[touching].min(initial=count)]
        contacts += [(int(people.step[r]), _contact(people, apart, r, time)) for r in now]
    instant, contact = min(contacts)
    return float(contact - time[0]) if instant else 0.0


def _contact(
    people: CrowdTrack, apart: NDArray[np.float64], r: int, time: NDArray[np.float64]
) -> float:
    """Return when [s] the distance became 0, shortly before the record ``r``."""
    k = people.step[r]
    before = (people.step == k - 1) & (people.pedestrian == people.pedestrian[r])
    if not before.any():  # first seen in the ego's place
        return float(time[k])
    distance = float(apart[before][0])
    share = distance / (distance - float(apart[r]))
    return float(time[k - 1] + share * (time[k] - time[k - 1]))


def _among(ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape, stop_speed: float) -> float:
    """Return the time [s] of all stops with people passing in front of and behind the ego."""
    stands = stops(ego, stop_speed)
    if not len(stands):
        return 0.0
    parts = [_passages(ego, part, shape) for part in crowd.by_people()]
    time, place = (np.concatenate(column) for column in zip(*parts, strict=True))
    total = 0.0
    for first, last in stands:
        during = (time >= ego.time[first]) & (time <= ego.time[last])
        if (place[during] > 0.0).any() and (place[during] < 0.0).any():
            total += float(np.ptp(time[during]))
    return total


def _passages(
    ego: EgoTrack, crowd: CrowdTrack, shape: VehicleShape
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return when [s] and where [m] people cross the ego's line of travel close to its bumpers.

    Places count from the ego's centre, positive in front.
    """
    groups = PedestrianGroups(crowd)
    order = groups.order
    step, poses = crowd.step[order], centre_poses(ego, shape)[crowd.step[order]]
    d_x, d_y = crowd.x[order] - poses[:, 0], crowd.y[order] - poses[:, 1]
    along = d_x * poses[:, 2] + d_y * poses[:, 3]
    aside = d_y * poses[:, 2] - d_x * poses[:, 3]
    follows = (np.diff(groups.pedestrian) == 0) & (np.diff(step) == 1)
    crossed = np.flatnonzero(follows & ((aside[:-1] < 0.0) != (aside[1:] < 0.0)))
    share = aside[crossed] / (aside[crossed] - aside[crossed + 1])
    place = along[crossed] + share * (along[crossed + 1] - along[crossed])
    begin, end = ego.time[step[crossed]], ego.time[step[crossed + 1]]
    beyond = np.abs(place) - shape.length / 2.0
    near = (beyond >= 0.0) & (beyond <= PASSING)
    return (begin + share * (end - begin))[near], place[near]
