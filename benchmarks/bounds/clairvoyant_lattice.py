"""The cheapest motion along a straight way if it is known what each step from each station costs.

Dynamic programming on a lattice that the limits span by themselves: in steps of tau the
acceleration changes by at most j tau = tau (du_max / h) / M, so accelerations are multiples of
j tau, speeds of j tau^2 and stations of j tau^3 / 2. Motions on it are exact, nothing is rounded.
What alpha v adds to du_max (at most 4 %) is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from giveway.geometry.kernel import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Choices = NDArray[np.uint8]
    Stations = NDArray[np.int64]

SOON = 3.0  # [s]
_TILE = 512  # stations whose costs a processor's nearest cache holds


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
        """Of costs: speeds, accelerations, stations."""
        return self.speeds + 1, self.highest - self.lowest + 1, self.stations


class Tolls(Protocol):
    """What the steps cost besides their time."""

    @property
    def last(self) -> int:
        """The instant from which on no step costs anything."""

    def fill(self, k: int, toll: Array) -> None:
        """Write the tolls [s] of the step from instant k to the next.

        Args:
            k: the instant.
            toll: (2 * speeds + 1, stations), by how many stations the step is long and from where
                it starts; a step of d from s ends at s + d, the goal or beyond included.
        """


class Course(NamedTuple):
    """A motion to the goal."""

    cost: float  # [s]: time and tolls
    time: float  # [s] to the goal
    stations: Stations  # (K,) of the front at each instant; the last is the goal or beyond
    speeds: Stations  # (K,)


def cheapest(tolls: Tolls, lattice: Lattice, speed: float, delay: float = SOON) -> Course:
    """The motion with the least time + tolls.

    Args:
        tolls: of the steps.
        lattice: of the drive.
        speed: at the start [m/s]; the acceleration is 0.
        delay: [s] beyond the shortest time; who is faster is found among fewer stations. A guess:
            what is found does not depend on it.
    """
    free = unhindered(lattice)
    everything = lattice.step * tolls.last + float(free[np.isfinite(free)].max())
    while True:
        latest = min(lattice.shortest + delay, everything)
        found = cheapest_by(latest, tolls, lattice, speed)
        if found.cost <= latest or latest == everything:
            return found  # whatever arrives later costs more
        delay = min(4.0 * delay, found.cost - lattice.shortest)


def cheapest_by(latest: float, tolls: Tolls, lattice: Lattice, speed: float) -> Course:
    """As :func:`cheapest`, of the motions that arrive by ``latest`` [s].

    Stations from which the goal is not reached by then are left out. The cost is inf if no motion
    arrives by then.
    """
    toll = _no_toll(lattice)
    in_time = int(min(latest / lattice.step, tolls.last))
    before, spare = np.full((2, *lattice.shape), np.inf)
    cost = unhindered(lattice) if in_time == tolls.last else spare
    choices: list[tuple[int, Choices]] = []
    for k in range(in_time - 1, -1, -1):
        left = lattice.top * (latest - k * lattice.step) / lattice.station  # can still be driven
        first = max(0, int(lattice.stations - min(left, lattice.stations)))
        reached = max(first, min(lattice.stations, 2 * lattice.speeds * k + 1))
        tolls.fill(k, toll)
        choices.append((first, _step_back(cost, toll, lattice, first, reached, before)))
        cost, before, spare = before, spare, before
    return _driven(choices[::-1], cost, lattice, round(speed / lattice.speed))


@cache
def unhindered(lattice: Lattice) -> Array:
    """Time to the goal [s], as ``lattice.shape``, where nothing costs anything any more."""
    reach = lattice.station * (lattice.stations - np.arange(lattice.stations))
    cost = np.broadcast_to(reach / lattice.top, lattice.shape).copy()
    before, toll = np.empty_like(cost), _no_toll(lattice)
    # So many steps it takes from a standstill at the start; then the values no longer change.
    for _ in range(round(lattice.shortest / lattice.step) + 40):
        _step_back(cost, toll, lattice, 0, lattice.stations, before)
        cost, before = before, cost
    return cost


def _no_toll(lattice: Lattice) -> Array:
    return np.zeros((2 * lattice.speeds + 1, lattice.stations))


def _step_back(
    after: Array, toll: Array, lattice: Lattice, first: int, reached: int, before: Array
) -> Choices:
    """Write the costs one step earlier into ``before``, where those below ``first`` are inf.

    Returns:
        By how much the acceleration changes there: 0, 1, 2 for less, the same, more.
    """
    before[:, :, reached:] = np.inf
    choice = np.empty((*lattice.shape[:2], reached - first), dtype=np.uint8)
    _improve(after, toll, lattice.step, lattice.lowest, first, reached, before, choice)
    return choice


def _driven(
    choices: list[tuple[int, Choices]], cost: Array, lattice: Lattice, speed: int
) -> Course:
    """Drive from the start by the choices, and on as fast as can be."""
    v, a, k, s = min(speed, lattice.speeds), -lattice.lowest, 0, 0
    stations, speeds, least = [s], [v], float(cost[v, a, 0])
    if np.isinf(least):
        return Course(least, least, np.array(stations), np.array(speeds))
    while s < lattice.stations:
        if k < len(choices):
            first, choice = choices[k]
            a += int(choice[v, a, s - first]) - 1
        else:
            a = _fastest_on(lattice, s, v, a)
        w = v + a + lattice.lowest
        s, v, k = s + v + w, w, k + 1
        stations.append(s)
        speeds.append(v)
    share = (lattice.stations - stations[-2]) / (stations[-1] - stations[-2])
    time = lattice.step * (k - 1 + share)
    return Course(least, time, np.array(stations), np.array(speeds))


def _fastest_on(lattice: Lattice, s: int, v: int, a: int) -> int:
    """The next acceleration of the fastest motion where nothing costs anything any more."""
    free = unhindered(lattice)
    speeds, accelerations, _ = lattice.shape
    best, found = np.inf, -1
    for b in range(max(0, a - 1), min(accelerations, a + 2)):
        w = v + b + lattice.lowest
        if 0 <= w < speeds:
            n = s + v + w
            beyond = n >= lattice.stations
            t = lattice.step * ((lattice.stations - s) / (n - s) if beyond else 1.0)
            t += 0.0 if beyond else float(free[w, b, n])
            if t < best:
                best, found = t, b
    return found


@kernel
def _improve(
    after: Array,
    toll: Array,
    tau: float,
    lowest: int,
    first: int,
    reached: int,
    before: Array,
    choice: Choices,
) -> None:
    """Bellman's equation, one step back in time, for the stations from ``first`` on.

    Rows of neighbouring stations, so that a processor takes several at once.
    """
    speeds, accelerations, goal = after.shape
    cost = np.full((accelerations + 2, _TILE), np.inf)  # by the next acceleration; none beyond
    for begin in range(first, reached, _TILE):
        end = min(begin + _TILE, reached)
        for v in range(speeds):
            for b in range(accelerations):
                row, w = cost[b + 1], v + b + lowest
                if w < 0 or w >= speeds:
                    row[:] = np.inf
                    continue
                d = v + w
                inside = min(end, max(begin, goal - d)) - begin
                price, onward = toll[d, begin:end], after[w, b, begin + d : begin + d + inside]
                for i in range(inside):
                    row[i] = tau + price[i] + onward[i]
                for i in range(inside, end - begin):
                    row[i] = tau * (goal - begin - i) / d + price[i]
            for a in range(accelerations):
                lower, same, higher = cost[a], cost[a + 1], cost[a + 2]
                least, chosen = before[v, a, begin:end], choice[v, a, begin - first : end - first]
                for i in range(end - begin):
                    best, which = lower[i], np.uint8(0)
                    if same[i] < best:
                        best, which = same[i], np.uint8(1)
                    if higher[i] < best:
                        best, which = higher[i], np.uint8(2)
                    least[i] = best
                    chosen[i] = which
