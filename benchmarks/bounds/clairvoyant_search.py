"""The fastest motion through people whose whole future is known, without touching any of them.

People become flags of each instant and station of the front bumper, flags become tolls, and the
cheapest motion on the lattice is the fastest one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from clairvoyant_lattice import Course, Lattice, Limits, cheapest

from giveway.geometry.kernel import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.run_data.tracks import CrowdTrack

    Array = NDArray[np.float64]
    Flags = NDArray[np.uint8]

__all__ = ["BELOW", "CONTACT", "CONTACT_PRICE", "Lattice", "Limits", "Motion", "People", "Rules"]
__all__ += ["fastest", "flags_of", "people_along"]

BELOW, CONTACT = 1, 2
CONTACT_PRICE = 1e6  # [s per s] so that no delay buys a contact


class People(NamedTuple):
    """Where everybody is, seen from the ego's start; nan: not there."""

    station: Array  # (K, n) [m] ahead of the front bumper's start
    offset: Array  # (K, n) [m] to the left of the way


class Motion(NamedTuple):
    """What the best motion takes."""

    completion_time: float  # [s]
    time_below: float  # [s] with somebody in front nearer than d_safe
    contact_time: float  # [s] in contact; above 0: no motion avoids it


@dataclass(frozen=True)
class Rules:
    """Who is in front, who is touched."""

    safe_distance: float = 8.0  # d_safe [m]
    half_corridor: float = 1.25  # [m]
    half_width: float = 1.0  # [m] of the ego
    body_radius: float = 0.27  # [m] of a person


def people_along(
    crowd: CrowdTrack,
    time_step: float,
    start: tuple[float, float, float],
    duration: float,
    tau: float,
) -> People:
    """The crowd in the ego's coordinates every ``tau`` seconds, for ``duration`` seconds.

    Who is there at the last recorded instant walks straight on from then.

    Args:
        crowd: every step from the ego's departure on.
        time_step: of the recording [s]; ``tau`` is a multiple of it.
        start: x, y [m] and heading [rad] of the front bumper at the start.
        duration: [s] from the departure on.
        tau: [s].
    """
    every = round(tau / time_step)
    instants = round(duration / tau) + 1
    shape = (instants, len(crowd.ids))
    station, offset = np.full(shape, np.nan), np.full(shape, np.nan)
    x_0, y_0, heading = start
    c, s = np.cos(heading), np.sin(heading)
    along = (crowd.x - x_0) * c + (crowd.y - y_0) * s
    across = (crowd.y - y_0) * c - (crowd.x - x_0) * s
    kept = (crowd.step % every == 0) & (crowd.step // every < instants)
    rows = crowd.step[kept] // every, crowd.pedestrian[kept]
    station[rows], offset[rows] = along[kept], across[kept]
    last = int(crowd.step.max(initial=0))
    ends = crowd.step == last
    who, end = crowd.pedestrian[ends], last * time_step
    later = np.arange(last // every + 1, instants)
    elapsed = (later * tau - end)[:, None]
    v_along, v_across = crowd.vx * c + crowd.vy * s, crowd.vy * c - crowd.vx * s
    station[np.ix_(later, who)] = along[ends] + elapsed * v_along[ends]
    offset[np.ix_(later, who)] = across[ends] + elapsed * v_across[ends]
    return People(station, offset)


def flags_of(people: People, lattice: Lattice, rules: Rules) -> Flags:
    """(K, stations) of each instant and front bumper's station: BELOW, CONTACT, or both."""
    flags = np.zeros((len(people.station), lattice.stations), dtype=np.uint8)
    _flag(
        people.station,
        np.abs(people.offset),
        lattice.station,
        rules.safe_distance,
        rules.half_corridor,
        rules.half_width,
        rules.body_radius,
        flags,
    )
    return flags


class FlagTolls:
    """What flags cost: ``below_price`` [s] for a second below d_safe, and contact."""

    def __init__(self, flags: Flags, lattice: Lattice, below_price: float) -> None:
        busy = np.flatnonzero(flags.any(axis=1))
        self.last = int(busy[-1]) if busy.size else 0
        self._flags = flags
        prices = np.array([0.0, below_price, CONTACT_PRICE, below_price + CONTACT_PRICE])
        self._prices = lattice.step * prices  # by flags

    def fill(self, k: int, toll: Array) -> None:
        """Write the tolls of the step from instant k: what is flagged at its end counts."""
        arrival_tolls(self._prices[self._flags[k + 1]], toll)


def fastest(flags: Flags, lattice: Lattice, speed: float, below_price: float) -> Motion:
    """The motion with the least completion time + price x time below d_safe, without contact.

    Args:
        flags: of :func:`flags_of`.
        lattice: of the drive.
        speed: at the start [m/s]; the acceleration is 0.
        below_price: [s] that a second below d_safe costs; a large one keeps d_safe wherever it can
            be kept.
    """
    course = cheapest(FlagTolls(flags, lattice, below_price), lattice, speed)
    met = _met(flags, course, lattice)
    below, contact = np.count_nonzero(met & BELOW), np.count_nonzero(met[1:] & CONTACT)
    return Motion(course.time, lattice.step * below, lattice.step * contact)


def _met(flags: Flags, course: Course, lattice: Lattice) -> Flags:
    """The flags where the course is, at each instant before the goal that has any."""
    stations = course.stations[: len(flags)]
    stations = stations[stations < lattice.stations]
    return flags[np.arange(stations.size), stations]


@kernel
def arrival_tolls(price: Array, toll: Array) -> None:
    """Have each step pay the ``price`` (stations,) of where it ends; nothing at the goal."""
    steps, stations = toll.shape
    for d in range(steps):
        for s in range(stations - d):
            toll[d, s] = price[s + d]
        for s in range(max(0, stations - d), stations):
            toll[d, s] = 0.0


@kernel
def _flag(
    station: Array,
    aside: Array,
    ds: float,
    safe_distance: float,
    half_corridor: float,
    half_width: float,
    radius: float,
    flags: Flags,
) -> None:
    stations = flags.shape[1]
    for k in range(station.shape[0]):
        for i in range(station.shape[1]):
            s, d = station[k, i], aside[k, i]
            if not (d <= max(half_corridor, half_width + radius)):
                continue
            if d <= half_corridor:
                first = int(np.floor((s - safe_distance) / ds)) + 1
                for n in range(max(0, first), min(stations, int(np.ceil(s / ds)))):
                    flags[k, n] |= BELOW
            beyond = max(0.0, d - half_width)
            if beyond < radius:
                reach = np.sqrt(radius * radius - beyond * beyond)
                first = int(np.floor((s - reach) / ds)) + 1
                for n in range(max(0, first), min(stations, int(np.ceil((s + reach) / ds)))):
                    flags[k, n] |= CONTACT
