"""Encounters at crossings: people's priority, and whether the ego let them pass.

The definitions, and the reason for each number, are in docs/law.md.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller.driving_constants import FIRM, PULL_AWAY_USUAL
from giveway.geometry.kernel import Array
from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive
from giveway.metrics.law.walks import Walk
from giveway.metrics.standing import runs

AHEAD = 4.0
"""Largest time [s] in which a person reaches the ego's path and is met."""

AFTER = 5.0
"""Time [s] after which a person who has left the ego's path is no longer met: the largest
post-encroachment time that SSAM considers (Gettman & Head 2003, FHWA)."""

TOUCHES, NOSE = 2.0, 1.4
"""Distance [m] to the ego's body, and time [s] of its driving, within which it may push a person.
Farther off, the model's vehicles act with less than 30 N (docs/law.md).
"""

ABOUT = 2.0
"""Time [s] before and after an event within which the counterfactual run shows the same event."""

BY = 20.0
"""Distance [m] before a crossing from which on the ego may push people there."""


class Encounter(NamedTuple):
    """An encounter of the ego with a person who has priority at a crossing."""

    area: Area
    walk: Walk
    first: int  # first control instant
    owed: NDArray[np.bool_]  # (m,) True where the ego has to let the person pass
    too_early: float  # [s] time by which the ego entered before the person left; 0 if it waited

    @property
    def failed(self) -> bool:
        """Return whether the ego failed to yield."""
        return self.too_early > 0.0


class PushedBack(NamedTuple):
    """A person with priority who moved back on a crossing."""

    area: Area
    walk: Walk
    farthest: int  # record of the walk from which on the person moved back
    distance: float  # [m]


def encounters(drive: Drive, area: Area, walk: Walk) -> list[Encounter]:
    """Return the encounter of one walk with the ego, in a list that is empty without one.

    Args:
        drive: Drive of the ego.
        area: Area of the crossing.
        walk: Walk over the crossing.
    """
    to_go, to_leave = walk.reach - walk.progress, walk.clear - walk.progress
    speed, room = drive.ego.speed[walk.steps], area.entry - drive.front[walk.steps]
    there = walk.priority & (to_leave > 0.0)
    meets = there & (to_go <= AHEAD * walk.desired_speed)
    meets &= (room > 0.0) & (speed**2 <= 2.0 * FIRM * room)
    meets &= room <= _comes(speed, drive.ego.speed.max(), to_leave / walk.desired_speed + AFTER)
    if not meets.any():
        return []
    owed = np.zeros(len(meets), dtype=np.bool_)
    too_early, enters = 0.0, drive.time_at(area.entry)
    for begin, end in runs(there):
        if not meets[begin:end].any():
            continue
        since = begin + int(np.argmax(meets[begin:end]))
        owed[since:end] = True
        too_early = max(too_early, _leaves(drive, walk, to_leave, end) - enters)
    return [Encounter(area, walk, int(walk.steps[np.argmax(meets)]), owed, too_early)]


def _comes(speed: Array, fastest: float, time: Array) -> Array:
    """Return the distance [m] that the ego drives in ``time`` [s], accelerating to ``fastest``."""
    faster = np.clip((fastest - speed) / PULL_AWAY_USUAL, 0.0, np.maximum(time, 0.0))
    return speed * faster + PULL_AWAY_USUAL / 2.0 * faster**2 + fastest * (time - faster)


def _leaves(drive: Drive, walk: Walk, to_leave: Array, end: int) -> float:
    """Return when [s] a person left the ego's path or lost priority before the record ``end``."""
    time = drive.ego.time[walk.steps]
    if end == len(time):
        return float(time[-1])
    before, after = to_leave[end - 1], to_leave[end]
    share = before / (before - after) if after <= 0.0 else 1.0
    return float(time[end - 1] + share * (time[end] - time[end - 1]))


def pushed_back(drive: Drive, area: Area, walk: Walk) -> list[PushedBack]:
    """Return how far a person with priority went back where the ego may have pushed them.

    Pushes by other people or by SUMO's vehicles do not count while the ego is far. Neither does a
    movement back that the same person makes in the counterfactual run.

    Args:
        drive: Drive of the ego.
        area: Area of the crossing.
        walk: Walk over the crossing.
    """
    front = drive.front[walk.steps]
    counts = walk.priority & (front >= area.entry - BY) & (front <= area.leave)
    pushes = _may_push(drive, walk)
    worst: PushedBack | None = None
    for begin, end in runs(counts):
        moved = np.diff(walk.progress[begin:end], prepend=walk.progress[begin])
        moved[(moved < 0.0) & ~pushes[begin:end]] = 0.0
        progress = np.cumsum(moved)
        back = np.maximum.accumulate(progress) - progress
        k = int(np.argmax(back))
        at = begin + int(np.argmax(progress[: k + 1]))
        distance = float(back[k]) - _goes_back_anyway(drive, area, walk, at, begin + k)
        if distance > (0.0 if worst is None else worst.distance):
            worst = PushedBack(area, walk, at, distance)
    return [] if worst is None else [worst]


def _goes_back_anyway(drive: Drive, area: Area, walk: Walk, first: int, last: int) -> float:
    """Return how far [m] the person moves back in the counterfactual run at about the same time."""
    twin = drive.undisturbed
    if twin is None:
        return 0.0
    time, steps = drive.ego.time, walk.steps
    since, until = time[steps[first]] - ABOUT, time[steps[last]] + ABOUT
    within = np.searchsorted(time, (since, until))
    mine = (twin.pedestrian == walk.pedestrian) & (twin.step >= within[0]) & (twin.step < within[1])
    u, _ = area.place(twin.x[mine], twin.y[mine])
    along, _ = area.place(walk.x[:1], walk.y[:1])
    onwards = np.isclose(along[0], walk.progress[0])
    progress = u if onwards else -u
    return float(np.max(np.maximum.accumulate(progress) - progress, initial=0.0))


def _may_push(drive: Drive, walk: Walk) -> NDArray[np.bool_]:
    """Return flags (m,) of the records at which the ego is near enough to push a person."""
    ego, k = drive.ego, walk.steps
    c, s = np.cos(ego.heading[k]), np.sin(ego.heading[k])
    d_x, d_y = walk.x - ego.front_x[k], walk.y - ego.front_y[k]
    ahead, aside = d_x * c + d_y * s, np.abs(d_y * c - d_x * s)
    beyond = np.maximum(np.maximum(ahead, -ahead - drive.shape.length), 0.0)
    beside = np.maximum(aside - drive.shape.width / 2, 0.0)
    reach = TOUCHES + NOSE * ego.speed[k] + drive.body_radius
    return np.asarray(np.hypot(beyond, beside) <= reach)


def waiting_time(drive: Drive, found: Encounter) -> float:
    """Return the time [s] for which a person stood although the ego had to let them pass."""
    lasting = np.append(np.diff(drive.ego.time), 0.0)[found.walk.steps]
    return float(lasting[found.owed & (found.walk.speed < drive.stop_speed)].sum())
