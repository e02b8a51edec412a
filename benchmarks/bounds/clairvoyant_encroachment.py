"""The fastest motion that leaves as many people as it can a second: post-encroachment time.

A person is *met* by a motion that brings the ego's body to a place within less than ``gap``
seconds of the person's being there: where giveway's metric finds a post-encroachment time below
that (Allen, Shin & Cooper 1978, as SSAM reads it). Seen from the ego's front such a person is a
stretch of stations at each instant; who drives into a stretch, or whom it reaches, has met that
person. The search pays a price for each person met. Somebody met twice is paid for twice, so that
a motion may be better than the search believes, never worse.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from clairvoyant_lattice import cheapest, cheapest_by
from clairvoyant_search import CONTACT, CONTACT_PRICE, arrival_tolls

from giveway.geometry.kernel import kernel
from giveway.metrics import encroachment
from giveway.run_data.tracks import CrowdTrack, EgoTrack

if TYPE_CHECKING:
    from clairvoyant_lattice import Course, Lattice
    from clairvoyant_search import Flags, People
    from numpy.typing import NDArray

    from giveway.geometry.bodies import VehicleShape

    Array = NDArray[np.float64]
    Mask = NDArray[np.bool_]
    Stations = NDArray[np.int64]

SECOND = 1.0  # [s] the study's limit of the post-encroachment time
_NOWHERE = 1 << 40  # a station
_ALMOST_NOTHING, _ANYTHING = 1e-3, 1e3  # [s] prices of a person
_LONG = 24.0  # [s] of delay, in which most crowds can be spared


@dataclass(frozen=True)
class Bodies:
    """What meets: the ego's rectangle and a person's circle."""

    shape: VehicleShape
    body_radius: float  # [m]


class Stretches(NamedTuple):
    """From which to which station the front meets each person; none where first > last."""

    first: Stations  # (K, n)
    last: Stations  # (K, n)

    def at(self, stations: Stations) -> Mask:
        """(k, n) who is met at each of the first k instants, (k,) of them."""
        k = slice(0, stations.size)
        here = stations[: len(self.first), None]
        return (self.first[k] <= here) & (here <= self.last[k])


def certain_gap(lattice: Lattice, time_step: float) -> float:
    """The gap [s] that makes sure of a second between the lattice's instants and the records'.

    Front and rear move less than a body's length in a step: a body that is at a place during a
    step is there at one of its ends; and somebody is recorded there within ``time_step``.
    """
    return SECOND + lattice.step + time_step


def stretches_of(
    people: People, lattice: Lattice, bodies: Bodies, time_step: float, gap: float
) -> Stretches:
    """Whom the front would meet where.

    Args:
        people: every ``time_step``.
        lattice: of the drive; its step is a multiple of that.
        bodies: the ego's and a person's.
        time_step: [s].
        gap: below which people are met [s].
    """
    every = round(lattice.step / time_step)
    shape = (len(people.station) - 1) // every + 1, people.station.shape[1]
    found = Stretches(np.full(shape, _NOWHERE), np.full(shape, -_NOWHERE))
    _stretch(
        people.station,
        np.abs(people.offset),
        lattice.station,
        every,
        int(np.ceil(gap / time_step - 1e-9)) - 1,  # less than the gap
        bodies.shape.length,
        bodies.shape.width / 2.0,
        bodies.body_radius,
        *found,
    )
    return found


class EncroachmentTolls:
    """``price`` [s] for each person met, and contact ahead."""

    def __init__(
        self, flags: Flags, stretches: Stretches, counted: Mask, lattice: Lattice, price: float
    ) -> None:
        """Prepare the tolls.

        Args:
            flags: of contact, (K, stations).
            stretches: of everybody.
            counted: (n,) whom to count; who is met at the start anyway is not.
            lattice: of the drive.
            price: [s].
        """
        counted = counted & ~stretches.at(np.zeros(1, dtype=np.int64))[0]
        self._first = np.ascontiguousarray(stretches.first[:, counted])
        self._last = np.ascontiguousarray(stretches.last[:, counted])
        self._contact = lattice.step * CONTACT_PRICE * ((flags & CONTACT) > 0)
        self._price = price
        there = (self._first <= self._last) & (self._last >= 0)
        there &= self._first <= lattice.stations + 2 * lattice.speeds
        busy = np.flatnonzero(there.any(axis=1) | (self._contact > 0.0).any(axis=1))
        self.last = int(busy[-1]) if busy.size else 0

    def fill(self, k: int, toll: Array) -> None:
        """Write the tolls of the step from instant k: who is met at its end and was not before."""
        arrival_tolls(self._contact[k + 1], toll)
        first, last = self._first, self._last
        _enter(first[k], last[k], first[k + 1], last[k + 1], self._price, toll)


class Vertex(NamedTuple):
    """A motion of a front: no other is faster at the price that it is the cheapest at."""

    course: Course
    met: int  # people paid for


class Search:
    """The motions through one recorded crowd."""

    def __init__(
        self, flags: Flags, stretches: Stretches, lattice: Lattice, speed: float, counted: Mask
    ) -> None:
        """Prepare it.

        Args:
            flags: of contact.
            stretches: where whom is met.
            lattice: of the drive.
            speed: at the start [m/s].
            counted: (n,) whom to pay for.
        """
        self._flags, self._counted = flags, counted
        self._stretches, self._lattice, self._speed = stretches, lattice, speed

    def fastest(self) -> Vertex:
        """The fastest motion, and of equally fast ones that which meets the fewest."""
        return self._paid(cheapest(self._tolls(_ALMOST_NOTHING), self._lattice, self._speed))

    def most_spared(self) -> Vertex:
        """Of the motions that meet as few as possible the fastest."""
        tolls = self._tolls(_ANYTHING)
        return self._paid(cheapest(tolls, self._lattice, self._speed, delay=_LONG))

    def front(self) -> list[Vertex]:
        """All motions that are the cheapest at some price, from the fastest on."""
        fastest, spared = self.fastest(), self.most_spared()
        return [fastest, *self._between(fastest, spared), spared]

    def _between(self, fast: Vertex, spared: Vertex) -> list[Vertex]:
        """The vertices between two of them."""
        fewer = fast.met - spared.met
        if fewer <= 1:
            return []
        price = (spared.course.time - fast.course.time) / fewer
        latest = spared.course.time + self._lattice.step
        course = cheapest_by(latest, self._tolls(price), self._lattice, self._speed)
        found = self._paid(course)
        if not spared.met < found.met < fast.met:
            return []
        better = fast.course.time + price * (fast.met - found.met) - found.course.time
        if better < 1e-6:
            return []
        return [*self._between(fast, found), found, *self._between(found, spared)]

    def _tolls(self, price: float) -> EncroachmentTolls:
        return EncroachmentTolls(self._flags, self._stretches, self._counted, self._lattice, price)

    def _paid(self, course: Course) -> Vertex:
        here = self._stretches.at(course.stations)[:, self._counted]
        return Vertex(course, int(np.count_nonzero(here[1:] & ~here[:-1] & ~here[0])))


def encroachments(
    course: Course,
    lattice: Lattice,
    people: People,
    bodies: Bodies,
    recorded: EgoTrack,
) -> Array:
    """(n,) the metric's post-encroachment times [s], had the ego driven the course.

    Args:
        course: of the ego.
        lattice: of the course.
        people: at the instants of ``recorded``, in the ego's coordinates.
        bodies: the ego's and a person's.
        recorded: a run's track of the ego, for its clock.
    """
    time_step = float(recorded.time[1] - recorded.time[0])
    every = round(lattice.step / time_step)
    share = np.arange(every) / every
    v, change = course.speeds[:-1, None], np.diff(course.speeds)[:, None]
    driven = lattice.station * course.stations[:-1, None] + lattice.speed * lattice.step * (
        v * share + change * share**2 / 2.0
    )
    x = np.append(driven.ravel(), lattice.station * course.stations[-1])
    x = x[: int(np.argmax(x >= lattice.station * lattice.stations - 1e-9)) + 1]
    instants = min(x.size, len(people.station))
    nought = np.zeros(x.size)
    ego = replace(
        recorded, time=time_step * np.arange(x.size), front_x=x, front_y=nought, heading=nought
    )
    step, who = np.nonzero(np.isfinite(people.station[:instants]))
    crowd = CrowdTrack(
        step=step,
        pedestrian=who,
        x=people.station[step, who],
        y=people.offset[step, who],
        vx=np.zeros(step.size),
        vy=np.zeros(step.size),
        ids=tuple(str(i) for i in range(people.station.shape[1])),
    )
    return encroachment(ego, crowd, bodies.shape, bodies.body_radius).time


@kernel
def _stretch(
    station: Array,
    aside: Array,
    ds: float,
    every: int,
    within: int,
    length: float,
    half_width: float,
    radius: float,
    first: Stations,
    last: Stations,
) -> None:
    for i in range(station.shape[1]):
        for j in range(station.shape[0]):
            s, d = station[j, i], aside[j, i]
            if not (d < half_width + radius):  # nor where nobody is
                continue
            beyond = max(0.0, d - half_width)
            reach = np.sqrt(radius * radius - beyond * beyond)
            near, far = int(np.ceil((s - reach) / ds)), int(np.floor((s + length + reach) / ds))
            earliest = max(0, -((within - j) // every))
            for k in range(earliest, min(first.shape[0] - 1, (j + within) // every) + 1):
                first[k, i] = min(first[k, i], near)
                last[k, i] = max(last[k, i], far)


@kernel
def _enter(
    first: Stations,
    last: Stations,
    then_first: Stations,
    then_last: Stations,
    price: float,
    toll: Array,
) -> None:
    steps, stations = toll.shape
    for i in range(first.size):
        if then_first[i] > then_last[i]:
            continue
        for d in range(steps):
            begin = max(0, then_first[i] - d)
            end = min(stations, then_last[i] - d + 1)
            for s in range(begin, min(end, first[i])):
                toll[d, s] += price
            if first[i] <= last[i]:
                for s in range(max(begin, last[i] + 1), end):
                    toll[d, s] += price
