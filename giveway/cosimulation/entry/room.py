"""The check that an ego has room: its place is free, and all vehicles could brake in time."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from giveway.ego.ego import Ego
from giveway.ego.perception.leader import outline_in_front
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.overlap import rectangles_overlap
from giveway.geometry.passage import BEHIND, window
from giveway.geometry.path import EgoPath
from giveway.sumo.background import BackgroundVehicles
from giveway.sumo.vehicles import SumoVehicles

STANDSTILL_GAP = 2.5
"""Gap [m] between two standing vehicles: minGap of SUMO's default car-following model."""

_REACTION = 1.0  # Reaction time [s] of SUMO's default car-following model


class Entry(NamedTuple):
    """The planned entry of an ego: its path, place, body, speed and braking."""

    path: EgoPath
    lane: str  # Lane on which the ego enters
    station: float  # Station [m] of its front bumper
    shape: VehicleShape
    speed: float  # Speed [m/s] at entry
    deceleration: float  # Deceleration [m/s^2] of its hardest braking

    @property
    def body(self) -> Array:
        """The ego's rectangle (5,), extended by the standstill gap before and behind."""
        x, y, heading = self.path.pose(self.station + STANDSTILL_GAP, self.shape.length)
        return np.array([x, y, heading, self.shape.length + 2 * STANDSTILL_GAP, self.shape.width])


def has_room(entry: Entry, vehicles: SumoVehicles, entered: Sequence[Ego]) -> bool:
    """Return whether the ego's place is free, and it and its followers can brake in time.

    Args:
        entry: Planned entry of the ego.
        vehicles: Vehicles of the running simulation.
        entered: Egos that enter at this instant, and are not on SUMO's road yet.
    """
    for ego in entered:
        there = np.array([*ego.pose, ego.shape.length, ego.shape.width])
        if rectangles_overlap(entry.body, there):
            return False
    others = vehicles.everybody_but("")
    if not others.ids:
        return True
    if rectangles_overlap(entry.body, others.bodies).any():
        return False
    return _can_stop_behind(entry, others) and _can_be_followed(entry, others, vehicles)


def _can_stop_behind(entry: Entry, others: BackgroundVehicles) -> bool:
    """Return whether the ego could stop behind all vehicles in front of it."""
    path, v = entry.path, entry.speed
    first, last = window(path.stations, entry.station, BEHIND)
    for x, y, heading, speed, length, width in zip(
        others.x, others.y, others.heading, others.speed, others.length, others.width, strict=True
    ):
        half = length / 2
        pose = np.array(
            [x - half * np.cos(heading), y - half * np.sin(heading), heading]
            + [speed, half, half, width]
        )
        station = outline_in_front(
            path.vertices, path.stations, first, last, pose, entry.station, entry.shape.width / 2
        )
        gap = station - entry.station
        if gap < _gap_to_follow(v, entry.deceleration, float(speed)):
            return False
    return True


def _can_be_followed(entry: Entry, others: BackgroundVehicles, vehicles: SumoVehicles) -> bool:
    """Return whether all vehicles that drive towards the ego's place could stop behind it."""
    x, y, _ = entry.path.pose(entry.station)
    for i, name in enumerate(others.ids):
        speed = float(others.speed[i])
        gap = _gap_to_follow(speed, vehicles.deceleration(name), entry.speed)
        reach = gap + entry.shape.length
        if np.hypot(others.x[i] - x, others.y[i] - y) > reach:
            continue
        lane, _, position = vehicles.whereabouts(name)
        if not lane:
            continue
        lanes = vehicles.lanes_ahead(name, lane, reach)
        if entry.lane not in lanes:
            continue
        before = sum(map(vehicles.lane_length, lanes[: lanes.index(entry.lane)]))
        distance = before - position + entry.station
        if 0.0 < distance < reach:
            return False
    return True


def _gap_to_follow(speed: float, deceleration: float, leader: float) -> float:
    """The gap [m] behind a leader that brakes as hard (Krauss 1998, section 2.2)."""
    braking = max(0.0, speed * speed - leader * leader) / (2.0 * deceleration)
    return STANDSTILL_GAP + speed * _REACTION + braking
