"""Stands of the ego on crossings and in junctions that it has to keep clear."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive, runs, spread
from giveway.metrics.law.walks import is_open

LONG = 2.0
"""[s] A shorter stand blocks nobody."""

BEFORE = 1.0
"""[s] A cause to stand counts from so long before it is there: to be early is careful."""

NEAR = 3.0
"""[m] Somebody who is this near in front keeps the ego from driving on."""

_SAME = 1e-6  # [s]
_WAITING = (-3.0, 0.5)  # [m] range about a line or a waiting place in which the ego waits


Owed = tuple[float, NDArray[np.bool_]]
"""Station [m] at which a crossing begins, and when (T,) the ego owes somebody the way there."""


class Blocked(NamedTuple):
    """A crossing or a junction that the ego blocked."""

    place: str  # the crossing's id or the junction's number
    first: int  # the control instant
    duration: float  # [s]


def blocked_crossings(
    drive: Drive, areas: tuple[Area, ...], owed: Sequence[Owed] = ()
) -> list[Blocked]:
    """Return the crossings on which the ego stood without having to, stand by stand.

    A crossing that is closed to people and empty is not blocked. Neither is one beside a place
    inside a junction where the ego may wait for vehicles to pass.

    Args:
        drive: Drive of the ego.
        areas: Areas on its way.
        owed: Times at which it had to let people pass at each of them.
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
    """Return the junctions in which the ego stood without having to, outside waiting places.

    Args:
        drive: Drive of the ego.
        areas: Areas on its way.
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
    """Return whether (T,) the ego's front is at a waiting place [m]."""
    off = drive.front - place
    return np.asarray((off >= _WAITING[0]) & (off <= _WAITING[1]))


def _lets_pass(drive: Drive, areas: Sequence[Area], owed: Sequence[Owed]) -> NDArray[np.bool_]:
    """Return whether (T,) people are to pass right in front of the ego, by right or not."""
    passing = np.zeros(len(drive.ego.time), dtype=np.bool_)
    on_it = [(area.entry, _used(drive, area)) for area in areas]
    for entry, there in (*owed, *on_it):
        room = entry - drive.front
        waiting = spread(drive.ego.time, there, BEFORE, 0.0)
        passing |= waiting & (room >= 0.0) & (room <= NEAR)
    return passing


def _used(drive: Drive, area: Area) -> NDArray[np.bool_]:
    """Return whether (T,) people are on a crossing."""
    crowd = drive.crowd
    u, w = area.place(crowd.x, crowd.y)
    on = (u >= 0.0) & (u <= area.length) & (np.abs(w) <= area.crossing.width / 2)
    used = np.zeros(len(drive.ego.time), dtype=np.bool_)
    used[crowd.step[on]] = True
    return used


def _stands(drive: Drive) -> NDArray[np.bool_]:
    return np.asarray(drive.ego.speed < drive.stop_speed)


def _longest(drive: Drive, wrong: NDArray[np.bool_]) -> list[tuple[int, float]]:
    """Return the longest uninterrupted wrong part of each stand: first instant, duration [s]."""
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
    """Return whether (T,) a body reaches into the ego's straight path within a distance [m].

    Args:
        drive: Drive of the ego.
        within: Distance [m] from the front bumper.
    """
    ego, crowd = drive.ego, drive.crowd
    k = crowd.step
    d_x, d_y = crowd.x - ego.front_x[k], crowd.y - ego.front_y[k]
    c, s = np.cos(ego.heading[k]), np.sin(ego.heading[k])
    ahead, aside = d_x * c + d_y * s, np.abs(d_y * c - d_x * s)
    near = (ahead > -drive.body_radius) & (ahead <= within + drive.body_radius)
    near &= aside <= drive.shape.width / 2 + drive.body_radius
    found = np.zeros(len(ego.time), dtype=np.bool_)
    found[k[near]] = True
    return found
