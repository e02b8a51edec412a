"""The fastest motion along a straight way through people whose whole future is known.

Dynamic programming on a lattice that the limits span by themselves: in steps of tau the
acceleration changes by at most j tau = tau (du_max / h) / M, so accelerations are multiples of
j tau, speeds of j tau^2 and stations of j tau^3 / 2. Motions on it are exact, nothing is rounded.
What alpha v adds to du_max (at most 4 %) is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from giveway.geometry.kernel import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from giveway.records.tracks import CrowdTrack

    Array = NDArray[np.float64]
    Flags = NDArray[np.uint8]
    Values = NDArray[np.float32]

BELOW, CONTACT = 1, 2
CONTACT_PRICE = 1e6  # [s per s] so that no delay buys a contact
_SOON = 3.0  # [s] of delay; who is faster is found among fewer stations


@dataclass(frozen=True)
class Limits:
    """What the ego can do: the plant and actuators of Yang & Özgüner 2019, table 1."""

    speed: float = 4.0  # v_r [m/s], never exceeded
    braking: float = 8.0  # u_max / M [m/s^2]; drag would add to it
    driving: float = 7.6  # (u_max - alpha v_r) / M [m/s^2]
    jerk: float = 20.0  # (du_max / h) / M [m/s^3]
    step: float = 0.1  # tau [s] of the lattice


@dataclass(frozen=True)
class Lattice:
    """Whole numbers of steps; the units follow from the step and the jerk."""

    speeds: int  # the highest speed
    lowest: int  # acceleration, negative
    highest: int  # acceleration
    stations: int  # the goal
    step: float  # [s]
    station: float  # [m]
    speed: float  # [m/s]

    @classmethod
    def of(cls, limits: Limits, goal: float) -> Lattice:
        """The lattice of a drive of ``goal`` [m]."""
        a = limits.jerk * limits.step
        v, s = a * limits.step, a * limits.step**2 / 2.0
        return cls(
            speeds=int(limits.speed / v + 1e-9),
            lowest=-int(limits.braking / a + 1e-9),
            highest=int(limits.driving / a + 1e-9),
            stations=round(goal / s),
            step=limits.step,
            station=s,
            speed=v,
        )

    @property
    def top(self) -> float:
        """The highest speed [m/s]."""
        return self.speed * self.speeds

    @property
    def shortest(self) -> float:
        """Completion time [s] at the highest speed."""
        return self.step * self.stations / (2 * self.speeds)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Of values: stations, speeds, accelerations."""
        return self.stations, self.speeds + 1, self.highest - self.lowest + 1


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


@cache
def unhindered(lattice: Lattice) -> Values:
    """Values (3, *lattice.shape) where nobody is in the way any more: time, below, contact."""
    values = np.zeros((3, *lattice.shape), dtype=np.float32)
    reach = lattice.station * (lattice.stations - np.arange(lattice.stations))
    values[0] = (reach / lattice.top)[:, None, None]
    flags = np.zeros(lattice.stations, dtype=np.uint8)
    # So many steps it takes from a standstill at the start; then the values no longer change.
    for _ in range(round(lattice.shortest / lattice.step) + 40):
        values = _step(values, flags, 0.0, lattice, (0, lattice.stations))
    return values


def fastest(flags: Flags, lattice: Lattice, speed: float, below_price: float) -> Motion:
    """The motion with the least completion time + price x time below d_safe, without contact.

    Args:
        flags: of :func:`flags_of`.
        lattice: of the drive.
        speed: at the start [m/s]; the acceleration is 0.
        below_price: [s] that a second below d_safe costs; a large one keeps d_safe wherever it can
            be kept.
    """
    soon = lattice.shortest + _SOON
    found = _fastest(flags, lattice, speed, below_price, soon)
    proven = found.contact_time == 0.0 and (below_price < 1.0 or found.time_below == 0.0)
    if proven and found.completion_time <= soon:
        return found  # whatever was left out takes longer
    return _fastest(flags, lattice, speed, below_price, np.inf)


def _fastest(
    flags: Flags, lattice: Lattice, speed: float, below_price: float, latest: float
) -> Motion:
    """As :func:`fastest`, without the stations from which the goal is not reached by ``latest``."""
    busy = np.flatnonzero(flags.any(axis=1))
    last = int(busy[-1]) if busy.size else 0
    values = unhindered(lattice)
    for k in range(last - 1, -1, -1):
        left = lattice.top * (latest - k * lattice.step) / lattice.station  # can still be driven
        first = 0 if np.isinf(latest) else max(0, int(lattice.stations - left))
        reached = min(lattice.stations, 2 * lattice.speeds * k + 1)
        if first < reached:
            values = _step(values, flags[k + 1], below_price, lattice, (first, reached))
    v = min(round(speed / lattice.speed), lattice.speeds)
    time, below, contact = (float(part[0, v, -lattice.lowest]) for part in values)
    start = lattice.step * float(flags[0, 0] & BELOW > 0)
    return Motion(time, below + start, contact)


def _step(
    values: Values, flags: Flags, price: float, lattice: Lattice, stations: tuple[int, int]
) -> Values:
    before = np.empty_like(values)
    before[:, : stations[0]] = np.inf
    before[:, stations[1] :] = np.inf
    _improve(values, flags, price, lattice.step, lattice.lowest, *stations, before)
    return before


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


@kernel
def _improve(
    values: Values,
    flags: Flags,
    price: float,
    tau: float,
    lowest: int,
    first: int,
    reached: int,
    before: Values,
) -> None:
    """Bellman's equation, one step back in time, for the stations from ``first`` on."""
    _, goal, speeds, accelerations = values.shape
    for s in range(first, reached):
        for v in range(speeds):
            for a in range(accelerations):
                best, time, below, contact = np.inf, np.inf, 0.0, 0.0
                for b in range(max(0, a - 1), min(accelerations, a + 2)):
                    w = v + b + lowest
                    if w < 0 or w >= speeds:
                        continue
                    n = s + v + w
                    if n >= goal:
                        t, below_s, contact_s = tau * (goal - s) / (n - s), 0.0, 0.0
                    else:
                        t = tau + values[0, n, w, b]
                        below_s = values[1, n, w, b] + tau * ((flags[n] & BELOW) > 0)
                        contact_s = values[2, n, w, b] + tau * ((flags[n] & CONTACT) > 0)
                    cost = t + price * below_s + CONTACT_PRICE * contact_s
                    if cost < best:
                        best, time, below, contact = cost, t, below_s, contact_s
                before[0, s, v, a] = time
                before[1, s, v, a] = below
                before[2, s, v, a] = contact
