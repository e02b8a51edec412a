"""People at a crossing: their progress over it, and their priority."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive
from giveway.run_data.tracks import CrowdTrack

KERB = 1.0
"""Distance [m] to a crossing's kerb within which a person who heads for it is about to use it."""

_OVER = 0.5  # Length [m] along a crossing below which a route does not cross there
_ON = 1.0  # Distance [m] beyond the kerb: who is first seen farther on entered with priority
_GREEN = np.array(["G", "g"])
_OUT = np.array(["O", "o"])
_SLOWEST = 0.1  # Smallest desired speed [m/s] used here, since it may be zero


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """The records of one person near a crossing, in order of time, for one route over it."""

    pedestrian: int
    steps: NDArray[np.int64]  # (m,) control instants
    progress: Array  # (m,) [m] in the person's own direction, from the kerb of entry
    priority: NDArray[np.bool_]  # (m,) True where the person has priority
    x: Array  # (m,) [m] place
    y: Array  # (m,) [m] place
    speed: Array  # (m,) [m/s] speed
    desired_speed: float  # [m/s]
    reach: float  # [m] progress at which the body reaches the ego's path
    clear: float  # [m] progress at which it has left it


def walks_over(drive: Drive, area: Area) -> list[Walk]:
    """Return the walks of all people over an area's crossing.

    Args:
        drive: Drive of the ego, with its crowd.
        area: Area of the crossing.
    """
    if not len(drive.people.step):
        return []
    crowd = CrowdTrack.joined([_near(area, part) for part in drive.crowd.pieces()])
    u, w = area.place(crowd.x, crowd.y)
    open_at = is_open(drive, area)
    walks = []
    for route in _routes(drive, area):
        mine = crowd.pedestrian == route.pedestrian
        rows = np.flatnonzero(mine & (crowd.step >= route.begin) & (crowd.step < route.end))
        if not len(rows):
            continue
        progress = u[rows] if route.onwards else area.length - u[rows]
        low, high = area.low, area.high
        if not route.onwards:
            low, high = area.length - high, area.length - low
        steps = crowd.step[rows]
        priority = _priority(drive, area, progress, w[rows], open_at[steps])
        walks.append(
            Walk(
                route.pedestrian,
                steps,
                progress,
                priority,
                crowd.x[rows],
                crowd.y[rows],
                np.hypot(crowd.vx[rows], crowd.vy[rows]),
                max(route.desired_speed, _SLOWEST),
                low - drive.body_radius,
                high + drive.body_radius,
            )
        )
    return walks


def _near(area: Area, crowd: CrowdTrack) -> CrowdTrack:
    """Return the records at an area's crossing, or close to its kerbs."""
    u, w = area.place(crowd.x, crowd.y)
    margin = area.crossing.width / 2 + KERB
    return crowd.where((u >= -KERB) & (u <= area.length + KERB) & (np.abs(w) <= margin))


def is_open(drive: Drive, area: Area) -> NDArray[np.bool_]:
    """Return flags (T,): people who are about to enter the crossing have priority.

    Args:
        drive: Drive of the ego.
        area: Area of the crossing.
    """
    crossing = area.crossing
    if not crossing.system:
        return np.full(len(drive.ego.time), crossing.zebra)
    letters = drive.letters(crossing.system, crossing.link, drive.ego.time)
    return np.isin(letters, _GREEN) | (np.isin(letters, _OUT) & crossing.zebra)


def _priority(
    drive: Drive, area: Area, progress: Array, aside: Array, open_at: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return flags (m,): a person has priority, record by record.

    At the kerb, a person has priority if the crossing is open. On the crossing, they keep the
    priority that they had at the kerb.
    """
    half = area.crossing.width / 2
    on = (progress >= 0.0) & (progress <= area.length)
    on &= np.abs(aside) <= half + drive.body_radius
    beside = np.maximum(np.abs(aside) - half, 0.0)
    kerb = (progress < 0.0) & (np.hypot(progress, beside) <= KERB)
    priority = np.empty(len(progress), dtype=np.bool_)
    by_right = area.crossing.system or area.crossing.zebra  # elsewhere people have no priority
    before = bool(on[0] and progress[0] > _ON and by_right)
    for k, (now, there, enters) in enumerate(
        zip(open_at.tolist(), on.tolist(), kerb.tolist(), strict=True)
    ):
        before = (there and (before or now)) or (enters and now)
        priority[k] = before
    return priority


class _Route(NamedTuple):
    """A route of one person that leads over a crossing."""

    pedestrian: int
    begin: int  # first control instant at which the route holds
    end: int  # first control instant at which the person's next route holds
    onwards: bool  # True from the crossing's first end to its second
    desired_speed: float  # [m/s]


def _routes(drive: Drive, area: Area) -> list[_Route]:
    """Return the routes that lead over the crossing."""
    people = drive.people
    u, w = area.place(people.x, people.y)
    another = np.diff(people.pedestrian, prepend=-1) != 0
    another[1:] |= np.diff(people.step) != 0
    begins = np.flatnonzero(another)
    joined = np.ones(len(u), dtype=np.bool_)
    joined[begins] = False  # each leg ends at a place, except at the first one of a route
    over = _along(u, w, area.length, area.crossing.width / 2 + drive.body_radius)
    over = np.add.reduceat(np.where(joined, over, 0.0), begins)
    found: list[_Route] = []
    ends: dict[int, int] = {}
    for number in range(len(begins) - 1, -1, -1):
        first = begins[number]
        who, begin = int(people.pedestrian[first]), int(people.step[first])
        end = ends.get(who, len(drive.ego.time))
        ends[who] = begin
        if abs(over[number]) > _OVER:
            speed = float(people.desired_speed[first])
            found.append(_Route(who, begin, end, bool(over[number] > 0.0), speed))
    return found[::-1]


def _along(u: Array, w: Array, length: float, half: float) -> Array:
    """Return the length (n,) [m] along the crossing of the leg that ends at each place.

    Only the part of a leg on the crossing counts: |w| at most ``half``, u from 0 to ``length``.
    """
    u_0, w_0 = np.roll(u, 1), np.roll(w, 1)
    d_u, d_w = u - u_0, w - w_0
    begin, end = np.zeros(len(u)), np.ones(len(u))
    for at, by, low, high in ((u_0, d_u, 0.0, length), (w_0, d_w, -half, half)):
        still = np.abs(by) < 1e-9
        safe = np.where(still, 1.0, by)
        one, other = (low - at) / safe, (high - at) / safe
        inside = (at >= low) & (at <= high)
        begin = np.maximum(
            begin, np.where(still, np.where(inside, 0.0, 2.0), np.minimum(one, other))
        )
        end = np.minimum(end, np.where(still, 1.0, np.maximum(one, other)))
    return d_u * np.maximum(end - begin, 0.0)
