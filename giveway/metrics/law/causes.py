"""Stops of the ego for which the road shows no cause.

A cause is looked for in where everybody was, not in what the ego took for one.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive, runs, spread
from giveway.metrics.law.encounters import AHEAD, Encounter
from giveway.metrics.law.standing import BEFORE, Owed
from giveway.run_data.way import JunctionOnWay

AFTER = 2.0
"""[s] A cause counts for so long after it was there."""

SIGHT = 10.0
"""[m] A cause counts this far in front of the ego."""

_ASIDE = 0.5  # [m] beside the ego's way people are on it as well
_FOE = 9.0  # [s] before another vehicle comes by: the largest critical gap, and time to start
_ROOM = 3.5  # [m] that the ego wants behind a crossing or a junction, besides its own length
_BEHIND = 40.0  # [m] from which on who follows it is no foe
_ABOUT, _SHORTEST = 20.0, 0.01  # [m] of path beyond what is looked at; a segment
_APART = 0.5  # [m] between points of its way
_STARTING = 3.0  # [s] in which an ego drives off that departs standing
_HALT = 1.0  # [m] about a scheduled stop
_AT_LINE, _OVER_LINE = 4.0, 0.5  # [m] before and beyond a stop sign's line, one stands at it
_POINTS = 5  # of a vehicle's middle line, front to rear
_GO = np.array(list("GgOo"))

Mask = NDArray[np.bool_]


class Uncaused(NamedTuple):
    """A stop without a cause."""

    first: int  # the first control instant without one
    duration: float  # [s] for which there was none


class _Stand(NamedTuple):
    """Where the ego stands, and when."""

    front: float  # [m] station
    sight: float  # [m] how far ahead a vehicle keeps it from driving on
    foes: float  # [m] how far ahead those pass for whom it waits
    begin: int  # the first control instant
    end: int  # and the one after the last


def stops_without_cause(
    drive: Drive, areas: Sequence[Area], owed: Sequence[Owed]
) -> list[Uncaused]:
    """The stops in which the ego stood while there was no cause, nor had been just before.

    Args:
        drive: the ego's.
        areas: on its way.
        owed: when it owed somebody the way at which of them.
    """
    time, found = drive.ego.time, []
    lasting = np.append(np.diff(time), 0.0)
    for begin, end in runs(drive.ego.speed < drive.stop_speed):
        front = float(drive.front[begin:end].mean())
        stand = _Stand(front, _sight(drive, areas, front), _foes(drive, front), begin, end)
        caused = np.zeros(len(time), dtype=np.bool_)
        if begin == 0:
            caused |= time <= time[0] + _STARTING
        for there, before in _causes(drive, stand, owed):
            caused |= spread(time, there, before + BEFORE, AFTER)
        wrong = ~caused[begin:end]
        if wrong.any():
            duration = float(lasting[begin:end][wrong].sum())
            found.append(Uncaused(begin + int(np.argmax(wrong)), duration))
    return found


def owed_to(drive: Drive, encounters: Sequence[Encounter]) -> list[Owed]:
    """Where and when the ego owed somebody the way.

    Args:
        drive: the ego's.
        encounters: of the drive.
    """
    found: dict[float, Mask] = {}
    for met in encounters:
        there = found.setdefault(met.area.entry, np.zeros(len(drive.ego.time), dtype=np.bool_))
        there[met.walk.steps[met.owed]] = True
    return list(found.items())


def _sight(drive: Drive, areas: Sequence[Area], front: float) -> float:
    """How far ahead a vehicle keeps the ego from leaving what it has to keep free [m]."""
    length = drive.shape.length
    kept_free = [(area.entry, area.leave) for area in areas]
    kept_free += [(place.entry, place.exit + length) for place in drive.way.junctions]
    rooms = (leave + _ROOM - front for entry, leave in kept_free if entry - SIGHT <= front < leave)
    return max([SIGHT, *rooms])


def _foes(drive: Drive, front: float) -> float:
    """How far ahead of its ``front`` [m] foes pass for whom the ego waits [m].

    As far as the junction goes in which or before which it stands: from where a network lets
    vehicles wait inside, it may be 17 m to where ways cross.
    """
    ends = [place.exit - front for place in drive.way.junctions if _at(place, front)]
    return max([SIGHT, *ends])


def _at(place: JunctionOnWay, front: float) -> bool:
    """Whether the front is in a junction, or right before it."""
    return place.entry - SIGHT <= front < place.exit


def _causes(drive: Drive, stand: _Stand, owed: Sequence[Owed]) -> Iterator[tuple[Mask, float]]:
    """When (T,) there was a cause of a stand, and how long [s] before that it counts."""
    time, front = drive.ego.time, stand.front
    for entry, there in owed:
        if front <= entry <= front + SIGHT:
            yield there, 0.0
    for line in drive.way.lines:
        if front <= line.station <= front + SIGHT:
            yield ~np.isin(drive.letters(line.system, line.link, time), _GO), 0.0
    for place in drive.way.junctions:
        if place.stop_sign and place.entry - _AT_LINE <= front <= place.entry + _OVER_LINE:
            yield np.arange(len(time)) == stand.begin, 0.0  # then it has stood there
    if any(halt.start - _HALT <= front <= halt.end + _HALT for halt in drive.way.halts):
        yield np.ones(len(time), dtype=np.bool_), 0.0
    yield _people_ahead(drive, stand), AHEAD
    yield _foes_ahead(drive, stand), 0.0
    yield _vehicles_ahead(drive, stand), 0.0


def _people_ahead(drive: Drive, stand: _Stand) -> Mask:
    """(T,) when somebody was on the ego's way in front of it."""
    crowd, front = drive.crowd, stand.front
    x, y, _ = drive.path.pose(front)
    rows = _during(drive, stand, drive.ego.time[crowd.step])
    reach = SIGHT + drive.shape.width + _ASIDE
    rows = rows[np.hypot(crowd.x[rows] - x, crowd.y[rows] - y) <= reach]
    station, aside = _on_path(drive, stand, crowd.x[rows], crowd.y[rows])
    on = aside <= drive.shape.width / 2 + drive.body_radius + _ASIDE
    on &= (station > front - drive.body_radius) & (station <= front + SIGHT)
    there = np.zeros(len(drive.ego.time), dtype=np.bool_)
    there[crowd.step[rows[on]]] = True
    return there


def _vehicles_ahead(drive: Drive, stand: _Stand) -> Mask:
    """(T,) when another vehicle was on the ego's way as far ahead of it as it looks."""
    rows = _during(drive, stand, drive.vehicles.time)
    ahead, _ = _on_way(drive, stand, rows, stand.sight)
    return _at_instants(drive, rows[ahead])


def _foes_ahead(drive: Drive, stand: _Stand) -> Mask:
    """(T,) when another vehicle was about to come onto the ego's way ahead, not from behind it.

    It did so within ``_FOE``, or would have if it had driven straight on at its speed.
    """
    others = drive.vehicles
    rows = _during(drive, stand, others.time)
    ahead, behind = _on_way(drive, stand, rows, stand.foes)
    coming = ahead | (_straight_on(drive, stand, rows) & ~behind)
    for name in np.unique(others.id[rows[ahead]]):
        mine = np.flatnonzero(others.id[rows] == name)
        coming[mine] |= spread(others.time[rows[mine]], ahead[mine], _FOE, 0.0) & ~behind[mine]
    return _at_instants(drive, rows[coming])


def _at_instants(drive: Drive, rows: NDArray[np.intp]) -> Mask:
    """(T,) the instants of some rows of other vehicles."""
    there = np.zeros(len(drive.ego.time), dtype=np.bool_)
    there[drive.instants(drive.vehicles.time[rows])] = True
    return there


def _on_way(drive: Drive, stand: _Stand, rows: NDArray[np.intp], sight: float) -> tuple[Mask, Mask]:
    """(n,) which vehicles are on the ego's way up to ``sight`` [m] ahead; (n,) behind its front."""
    others, front = drive.vehicles, stand.front
    ahead, behind = np.zeros((2, len(rows)), dtype=np.bool_)
    x, y, _ = drive.path.pose(front)
    reach = max(sight, _BEHIND) + others.length[rows] + others.width[rows]
    near = np.flatnonzero(np.hypot(others.x[rows] - x, others.y[rows] - y) <= reach)
    rows = rows[near]
    back = np.linspace(0.0, 1.0, _POINTS) * others.length[rows, None]
    p_x = others.x[rows, None] - back * np.cos(others.heading[rows, None])
    p_y = others.y[rows, None] - back * np.sin(others.heading[rows, None])
    station, aside = (each.reshape(back.shape) for each in _on_path(drive, stand, p_x, p_y))
    on = aside <= (drive.shape.width + others.width[rows, None]) / 2
    ahead[near] = (on & (station > front) & (station <= front + sight)).any(axis=1)
    behind[near] = (on & (station <= front)).any(axis=1)
    return ahead, behind & ~ahead


def _straight_on(drive: Drive, stand: _Stand, rows: NDArray[np.intp]) -> Mask:
    """(n,) which vehicles would come onto the ego's way ahead, driving straight on for a while."""
    others, front = drive.vehicles, stand.front
    at = np.arange(front, front + stand.foes + _APART, _APART)
    way = shapely.LineString(drive.path.points(at)).buffer(drive.shape.width / 2, cap_style="flat")
    x, y, far = others.x[rows], others.y[rows], _FOE * others.speed[rows]
    c, s = np.cos(others.heading[rows]), np.sin(others.heading[rows])
    lines = shapely.linestrings(
        np.stack([x, y, x + far * c, y + far * s], axis=1).reshape(-1, 2, 2)
    )
    return np.asarray(shapely.intersects(way, lines))


def _during(drive: Drive, stand: _Stand, time: Array) -> NDArray[np.intp]:
    """The rows (of ascending ``time`` [s]) that may be the cause of a stand."""
    own = drive.ego.time
    since, until = own[stand.begin] - AFTER, own[stand.end - 1] + _FOE + BEFORE
    return np.arange(*np.searchsorted(time, (since, until)))


def _on_path(drive: Drive, stand: _Stand, x: Array, y: Array) -> tuple[Array, Array]:
    """Stations and distances (n,) [m] of points beside the ego's path about where it stands.

    A way may come by twice: the rest of it is not looked at.
    """
    stations = drive.path.stations
    begin = max(stand.front - _BEHIND, 0.0)
    end = min(stand.front + max(stand.sight, stand.foes) + _ABOUT, stations[-1])
    between = stations[(stations > begin + _SHORTEST) & (stations < end - _SHORTEST)]
    part = EgoPath.through(drive.path.points(np.array([begin, *between, end])))
    station, lateral = part.project(np.column_stack([x.ravel(), y.ravel()]))
    return begin + station, np.abs(lateral)
