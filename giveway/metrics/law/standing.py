"""Stands of the ego on crossings and in junctions that it has to keep clear."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive, spread
from giveway.metrics.law.walks import is_open
from giveway.metrics.standing import runs

LONG = 2.0
"""Time [s] up to which a stand blocks nobody."""

BEFORE = 1.0
"""Time [s] before a cause is there, from which on it counts: to stop early is careful."""

NEAR = 3.0
"""Distance [m] in front within which a person or vehicle keeps the ego from driving on."""

_SAME = 1e-6  # Difference [s] up to which two durations are one
_WAITING = (-3.0, 0.5)  # Range [m] around a line or a waiting place in which the ego waits


Owed = tuple[float, NDArray[np.bool_]]
"""Station [m] at which a crossing begins, and flags (T,): the ego has to let somebody pass
there."""


class Blocked(NamedTuple):
    """A crossing or a junction that the ego blocked."""

    place: str  # the crossing's id or the junction's number
    first: int  # first control instant
    duration: float  # [s] time for which it was blocked


def blocked_crossings(
    drive: Drive, areas: tuple[Area, ...], owed: Sequence[Owed] = ()
) -> list[Blocked]:
    """Return the crossings on which the ego stood without need, one entry per stand.

    A crossing that is closed to people and empty is not blocked. Neither is one beside a place
    inside a junction where the ego may wait for vehicles to pass.

    Args:
        drive: Drive of the ego.
        areas: Areas of crossings on its path.
        owed: Times at which it had to let people pass at each crossing.
    """
    free = _stands(drive) & ~somebody_in_front(drive) & ~_lets_pass(drive, areas, owed)
    for junction in drive.way.junctions:
        for place in junction.waiting:
            free &= ~_waits_at(drive, place)
    front, found = drive.front, list[Blocked]()
    for area in areas:
        on = free & (front > area.entry) & (front < area.leave)
        if on.any():
            closed = bool(area.crossing.system) & ~is_open(drive, area)
            on &= ~closed | _used(drive, area)
        found += [Blocked(area.crossing.lane, *longest) for longest in _longest(drive, on)]
    return found


def blocked_junctions(
    drive: Drive, areas: tuple[Area, ...] = (), owed: Sequence[Owed] = ()
) -> list[Blocked]:
    """Return the junctions in which the ego stood without need, outside waiting places.

    Args:
        drive: Drive of the ego.
        areas: Areas of crossings on its path.
        owed: Times at which it had to let people pass at a crossing.
    """
    free = _stands(drive) & ~somebody_in_front(drive) & ~_lets_pass(drive, areas, owed)
    found = list[Blocked]()
    for number, junction in enumerate(drive.way.junctions):
        inside = drive.front > junction.entry + _WAITING[1]
        inside &= drive.front < junction.exit + drive.shape.length
        for place in junction.waiting:
            inside &= ~_waits_at(drive, place)
        found += [Blocked(str(number), *longest) for longest in _longest(drive, free & inside)]
    return found


def _waits_at(drive: Drive, place: float) -> NDArray[np.bool_]:
    """Return flags (T,): the ego's front is at a waiting place with the station ``place`` [m]."""
    off = drive.front - place
    return np.asarray((off >= _WAITING[0]) & (off <= _WAITING[1]))


def _lets_pass(drive: Drive, areas: Sequence[Area], owed: Sequence[Owed]) -> NDArray[np.bool_]:
    """Return flags (T,): the ego lets people pass right in front of it, with priority or not."""
    passing = np.zeros(len(drive.ego.time), dtype=np.bool_)
    on_it = [(area.entry, _used(drive, area)) for area in areas]
    for entry, there in (*owed, *on_it):
        room = entry - drive.front
        waiting = spread(drive.ego.time, there, BEFORE, 0.0)
        passing |= waiting & (room >= 0.0) & (room <= NEAR)
    return passing


def _used(drive: Drive, area: Area) -> NDArray[np.bool_]:
    """Return flags (T,): people are on a crossing."""
    used = np.zeros(len(drive.ego.time), dtype=np.bool_)
    for crowd in drive.crowd.pieces():
        u, w = area.place(crowd.x, crowd.y)
        on = (u >= 0.0) & (u <= area.length) & (np.abs(w) <= area.crossing.width / 2)
        used[crowd.step[on]] = True
    return used


def _stands(drive: Drive) -> NDArray[np.bool_]:
    return np.asarray(drive.ego.speed < drive.stop_speed)


def _longest(drive: Drive, wrong: NDArray[np.bool_]) -> list[tuple[int, float]]:
    """Return the longest part of each stand where ``wrong`` holds: first instant, duration [s]."""
    time, found = drive.ego.time, []
    for begin, end in runs(_stands(drive)):
        parts = [
            (float(time[min(begin + b, len(time) - 1)] - time[begin + a]), begin + a)
            for a, b in runs(wrong[begin:end])
        ]
        duration, first = max(parts, default=(0.0, 0))
        if duration >= LONG - _SAME:
            found.append((first, duration))
    return found


def somebody_in_front(drive: Drive, within: float = NEAR) -> NDArray[np.bool_]:
    """Return flags (T,): a body reaches into the ego's straight path within a distance [m].

    Args:
        drive: Drive of the ego.
        within: Distance [m] from the front bumper.
    """
    ego = drive.ego
    found = np.zeros(len(ego.time), dtype=np.bool_)
    for crowd in drive.crowd.pieces():
        k = crowd.step
        d_x, d_y = crowd.x - ego.front_x[k], crowd.y - ego.front_y[k]
        c, s = np.cos(ego.heading[k]), np.sin(ego.heading[k])
        ahead, aside = d_x * c + d_y * s, np.abs(d_y * c - d_x * s)
        near = (ahead > -drive.body_radius) & (ahead <= within + drive.body_radius)
        near &= aside <= drive.shape.width / 2 + drive.body_radius
        found[k[near]] = True
    return found
