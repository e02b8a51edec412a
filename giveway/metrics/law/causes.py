"""Stops of the ego without a cause on the road.

A cause is searched in the positions of all road users, not in the ego's own reasons.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.metrics.law.areas import Area
from giveway.metrics.law.drive import Drive, spread
from giveway.metrics.law.encounters import AHEAD, Encounter
from giveway.metrics.law.standing import BEFORE, Owed
from giveway.metrics.standing import runs

AFTER = 2.0
"""Time [s] for which a cause still counts after it has gone."""

SIGHT = 10.0
"""Distance [m] in front of the ego within which a cause counts."""

_ASIDE = 0.5  # [m] distance beside the ego's path within which people block it
_FOE = 9.0  # Largest time [s] to another vehicle: critical headway plus time to start
_ROOM = 3.5  # [m] space that the ego wants behind a crossing or junction, besides its length
# Distance [m] behind the ego from which a vehicle is a follower, not a conflicting vehicle
_BEHIND = 40.0
_ABOUT, _SHORTEST = 20.0, 0.01  # Lengths [m]: path beyond the examined part, shortest segment
_APART = 0.5  # Distance [m] between examined points of the path
_STARTING = 3.0  # Time [s] in which an ego that departs from standstill drives off
_HALT = 1.0  # Tolerance [m] around a scheduled stop
_AT_LINE, _OVER_LINE = 4.0, 0.5  # Range [m] before and behind a stop line
_POINTS = 5  # Number of points on a vehicle's middle line, front to rear
_GO = np.array(list("GgOo"))

Mask = NDArray[np.bool_]


class Uncaused(NamedTuple):
    """A stop without a cause."""

    first: int  # [s] time without a cause
    duration: float  # [s] duration without a cause


class _Stand(NamedTuple):
    """A stand of the ego: its place, its time and how far it looks."""

    front: float  # [m] station of the front
    sight: float  # [m] distance ahead within which a vehicle prevents the ego from driving on
    foes: float  # [m] distance ahead within which crossing vehicles make the ego wait
    begin: int  # first control instant
    end: int  # control instant after the last one


def stops_without_cause(
    drive: Drive, areas: Sequence[Area], owed: Sequence[Owed]
) -> list[Uncaused]:
    """Return the stops during which the ego stood without a present or recent cause.

    Args:
        drive: Drive of the ego.
        areas: Areas of crossings on its path.
        owed: Times at which it had to let people pass at each crossing.
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
    """Return where and when the ego had to let people pass.

    Args:
        drive: Drive of the ego.
        encounters: Encounters of the drive.
    """
    found: dict[float, Mask] = {}
    for met in encounters:
        there = found.setdefault(met.area.entry, np.zeros(len(drive.ego.time), dtype=np.bool_))
        there[met.walk.steps[met.owed]] = True
    return list(found.items())


def _sight(drive: Drive, areas: Sequence[Area], front: float) -> float:
    """Return the distance [m] ahead within which a vehicle holds the ego on a keep-clear area."""
    length = drive.shape.length
    kept_free = [(area.entry, area.leave) for area in areas]
    kept_free += [(place.entry, place.exit + length) for place in drive.way.junctions]
    rooms = (leave + _ROOM - front for entry, leave in kept_free if entry - SIGHT <= front < leave)
    return max([SIGHT, *rooms])


def _foes(drive: Drive, front: float) -> float:
    """Return the distance [m] ahead of ``front`` within which crossing vehicles make the ego wait.

    It reaches to the end of the junction in which or before which the ego stands. From a waiting
    place inside a junction, the paths may cross 17 m ahead.
    """
    there = (place for place in drive.way.junctions if place.entry - SIGHT <= front < place.exit)
    return max([SIGHT, *(place.exit - front for place in there)])


def _causes(drive: Drive, stand: _Stand, owed: Sequence[Owed]) -> Iterator[tuple[Mask, float]]:
    """Yield the instants (T,) at which each cause was there, and how long [s] before it counts."""
    time, front = drive.ego.time, stand.front
    for entry, there in owed:
        if front <= entry <= front + SIGHT:
            yield there, 0.0
    for line in drive.way.lines:
        if front <= line.station <= front + SIGHT:
            yield ~np.isin(drive.letters(line.system, line.link, time), _GO), 0.0
    for place in drive.way.junctions:
        past = front - (place.entry - place.offset)
        if place.stop_sign and -_AT_LINE <= past <= _OVER_LINE:
            # the ego has just come to a stop at the sign
            yield np.arange(len(time)) == stand.begin, 0.0
    if any(halt.start - _HALT <= front <= halt.end + _HALT for halt in drive.way.halts):
        yield np.ones(len(time), dtype=np.bool_), 0.0
    yield _people_ahead(drive, stand, SIGHT), AHEAD
    if stand.foes > SIGHT:  # the ego may wait for people rather than stop in the junction
        yield _people_ahead(drive, stand, stand.foes), _FOE
    yield _foes_ahead(drive, stand), 0.0
    yield _vehicles_ahead(drive, stand), 0.0


def _people_ahead(drive: Drive, stand: _Stand, sight: float) -> Mask:
    """Return when a person was on the ego's path up to ``sight`` [m] in front, as flags (T,)."""
    front, there = stand.front, np.zeros(len(drive.ego.time), dtype=np.bool_)
    x, y, _ = drive.path.pose(front)
    reach = sight + drive.shape.width + _ASIDE
    for crowd in drive.crowd.pieces():
        rows = _during(drive, stand, drive.ego.time[crowd.step])
        rows = rows[np.hypot(crowd.x[rows] - x, crowd.y[rows] - y) <= reach]
        station, aside = _on_path(drive, stand, crowd.x[rows], crowd.y[rows])
        on = aside <= drive.shape.width / 2 + drive.body_radius + _ASIDE
        on &= (station > front - drive.body_radius) & (station <= front + sight)
        there[crowd.step[rows[on]]] = True
    return there


def _vehicles_ahead(drive: Drive, stand: _Stand) -> Mask:
    """Return when another vehicle was on the ego's path within its sight, as flags (T,)."""
    rows = _during(drive, stand, drive.vehicles.time)
    ahead, _ = _on_way(drive, stand, rows, stand.sight)
    return _at_instants(drive, rows[ahead])


def _foes_ahead(drive: Drive, stand: _Stand) -> Mask:
    """Return when another vehicle, not a follower, was about to enter the ego's path: flags (T,).

    It entered the path within ``_FOE``, or would have entered it straight on at its speed.
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
    """Return the instants (T,) of some rows of other vehicles."""
    there = np.zeros(len(drive.ego.time), dtype=np.bool_)
    there[drive.instants(drive.vehicles.time[rows])] = True
    return there


def _on_way(drive: Drive, stand: _Stand, rows: NDArray[np.intp], sight: float) -> tuple[Mask, Mask]:
    """Return flags (n,) of the vehicles on the ego's path ahead, and of those behind its front."""
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
    """Return flags (n,) of the vehicles that would soon enter the ego's path, going straight on."""
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
    """Return the rows, in order of ``time`` [s], of vehicles that may be the cause of a stand."""
    own = drive.ego.time
    since, until = own[stand.begin] - AFTER, own[stand.end - 1] + _FOE + BEFORE
    return np.arange(*np.searchsorted(time, (since, until)))


def _on_path(drive: Drive, stand: _Stand, x: Array, y: Array) -> tuple[Array, Array]:
    """Return stations and lateral distances (n,) [m] of points beside the ego's path.

    A path may pass a place twice, so only its part near the stand counts.
    """
    stations = drive.path.stations
    begin = max(stand.front - _BEHIND, 0.0)
    end = min(stand.front + max(stand.sight, stand.foes) + _ABOUT, stations[-1])
    between = stations[(stations > begin + _SHORTEST) & (stations < end - _SHORTEST)]
    part = EgoPath.through(drive.path.points(np.array([begin, *between, end])))
    station, lateral = part.project(np.column_stack([x.ravel(), y.ravel()]))
    return begin + station, np.abs(lateral)
