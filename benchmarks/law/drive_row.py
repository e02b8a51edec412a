"""The measures of one drive on roads, from the recorded states of all road users."""

from __future__ import annotations

from collections import Counter
from math import inf, nan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from controller import VehicleLayer
from controller.driving_constants import COMFORTABLE, FIRM
from giveway.ego.rules.speed_profile import in_bends, of_lanes
from giveway.metrics.baseline import times
from giveway.metrics.law.areas import areas_of
from giveway.metrics.standing import runs
from giveway.metrics.summary import hard_brakes
from giveway.sumo.network.lane_path import SpeedLimit

if TYPE_CHECKING:
    from giveway import RunResult
    from giveway.metrics.law import Drive
    from giveway.results.ego_result import EgoResult
    from giveway.sumo.plain_drive import PlainDrive

COUNTS = (
    "encounters",
    "failures_to_yield",
    "red_lights_run",
    "stops_without_cause",
    "frontal_contacts",
    "side_contacts",
)
LOST = ("bends", "lights", "far lights", "following", "yielding", "people", "starting", "other")
SLOW = 4.0  # Speed [m/s] below which driving with the way free is slow
FREE_GAP, FREE_LINE = 30.0, 15.0  # Distances [m] to a vehicle and, besides braking, to a line
LONG_STAND = 4.0  # Duration [s] from which on a stand on a crossing or in a junction counts
TAKING_OVER = 2.0  # Time [s] after the departure in which nothing abrupt may happen
_AROUND = 0.5  # Time [s] around the beginning of a braking in which its cause is searched
_NEEDED = 1.5  # Deceleration [m/s^2] from which on an obstacle is a cause of hard braking
_AT = 3.0  # Distance [m] around a stop line or crossing at which a stop belongs to it
_OVER = 0.3  # Speed [m/s] above a limit that is rounding of the controller
_ROUNDING = 1e-6  # [m/s^2] of a braking with the firm limit itself
_GRID = 0.5  # Distance [m] between the stations at which limits are known

Mask = NDArray[np.bool_]
Floats = NDArray[np.float64]


def row_of(result: RunResult) -> dict[str, Any]:
    """Return the measures of the first ego's drive.

    Args:
        result: Result of a run in which plain SUMO made the same trip.
    """
    ego, summary = result.egos[0], result.summary
    plain = None if ego.plain is None else ego.plain.at_limit
    own, sumo = times(ego.track, ego.goal, plain)
    teleported = plain is not None and plain.teleported > 0.0
    row = {
        "ending": str(ego.ending.value),
        "arrived": bool(summary["completed"]),
        "sumo_arrived": None if plain is None or teleported else plain.arrived,
        "sumo_teleported": teleported,
        "time": summary["completion_time"],
        "sumo_time": sumo,
        "ratio": own / sumo if summary["completed"] else nan,
        "driving_time": float(ego.track.time[-1] - ego.track.time[0]),
        "distance": summary["travelled_distance"],
        "person_near": bool(summary["people_near"] or summary.get("encounters")),
        **{name: int(summary.get(name) or 0) for name in COUNTS},
        **_comfort(ego),
        "rms_jerk": summary["rms_jerk"],
    }
    if ego.drive is not None:
        row |= _on_roads(ego, ego.drive, plain)
    events = ego.ledger.violations if ego.ledger is not None else ()
    row["violations"] = [
        f"{event.time:.2f} s, {event.kind}, {event.other or event.place}: {event.words}"
        for event in events
    ]
    return row


class _Road(NamedTuple):
    """The drive's conditions at each control instant (T,)."""

    drive: Drive
    front: Floats  # [m] station of the front bumper
    limit: Floats  # [m/s] limit of the lane
    free: Floats  # [m/s] lowest free speed, by limits and bends, up to the braking distance
    line: Floats  # [m] distance to the next stop line of a light; inf without one
    red: Mask  # True if this light does not show green
    braking: Floats  # [m] comfortable braking distance


def _on_roads(ego: EgoResult, drive: Drive, plain: PlainDrive | None) -> dict[str, Any]:
    """Return the measures for which the rules along the path are needed."""
    road = _road_of(ego, drive)
    brakings = [_cause_of_braking(road, int(k)) for k in hard_brakes(drive.ego)]
    share, sumo_share = _slow_share(road), _slow_share_of(plain, road)
    contacts = {one.id: _fault(ego, one.id, one.first) for one in ego.vehicle_contacts}
    early = drive.ego.time <= drive.ego.time[0] + TAKING_OVER
    over = _lasting(drive.ego.time)[drive.ego.speed > road.limit + _OVER].sum()
    return {
        "brakings": brakings,
        "take_over_braking": float(max(0.0, -drive.ego.acceleration[early].min())),
        "take_over_felt": bool((drive.ego.acceleration[early] < -FIRM - _ROUNDING).any()),
        "stands": _stands(road),
        "gaps_at_rest": _gaps_at_rest(drive),
        "car_contacts": contacts,
        "slow_share": share,
        "sumo_slow_share": sumo_share,
        "over_limit": float(over),
        "lost": _time_lost(road),
    }


def _road_of(ego: EgoResult, drive: Drive) -> _Road:
    front, speed, length = drive.front, drive.ego.speed, drive.shape.length
    stations = np.arange(0.0, drive.path.length + _GRID, _GRID)
    limits = [SpeedLimit(*limit) for limit in drive.way.limits]
    of_lane = np.minimum(of_lanes(limits, stations), ego.config.vehicle.speed_max)
    bends = np.minimum(of_lane, in_bends(drive.path, length, stations))
    braking = speed**2 / (2.0 * COMFORTABLE)
    first = np.clip((front / _GRID).astype(np.int64), 0, len(stations) - 1)
    last = np.clip(((front + braking) / _GRID).astype(np.int64) + 1, 0, len(stations) - 1)
    free = np.array([bends[a : b + 1].min() for a, b in zip(first, last, strict=True)])
    line, red = np.full(len(front), inf), np.zeros(len(front), dtype=np.bool_)
    for stop in sorted(drive.way.lines, key=lambda one: -one.station):
        before = front <= stop.station
        line[before] = stop.station - front[before]
        letters = drive.letters(stop.system, stop.link, drive.ego.time)
        red[before] = ~np.isin(letters, list("GgOo"))[before]
    return _Road(drive, front, of_lane[first], free, line, red, braking)


def _comfort(ego: EgoResult) -> dict[str, float]:
    """Return what 95 % of the driving time does not exceed [m/s^2]."""
    track = ego.track
    moving = track.speed > 0.5
    if moving.sum() < 3:
        return {"acceleration_95": nan, "braking_95": nan, "lateral_95": nan}
    rate = np.gradient(np.unwrap(track.heading), track.time)
    lateral = np.abs(track.speed * rate)[moving]
    along = track.acceleration[moving]
    columns = np.maximum(along, 0.0), np.maximum(-along, 0.0), lateral
    values = (float(np.percentile(column, 95.0)) for column in columns)
    return dict(zip(("acceleration_95", "braking_95", "lateral_95"), values, strict=True))


def _cause_of_braking(road: _Road, k: int) -> dict[str, Any]:
    """Return time, deceleration and cause of a hard braking that begins at instant ``k``."""
    ego, drive = road.drive.ego, road.drive
    first, last = np.searchsorted(ego.time, (ego.time[k] - _AROUND, ego.time[k] + _AROUND))
    part = slice(int(first), int(last) + 1)
    needed = {
        "person": _needed(ego.speed[part], 0.0, ego.gap[part] - 1.0),
        "vehicle": _needed(ego.speed[part], _leader_speed(drive, part), ego.vehicle_gap[part] - 1),
        "stop": _needed(ego.speed[part], 0.0, ego.stop_gap[part]),
    }
    reasons = set(ego.reason[part][ego.controller[part] == "safety"].tolist())
    cause = max(needed, key=lambda name: needed[name])
    if VehicleLayer.REASON in reasons:
        cause = "vehicle"
    elif reasons:
        cause = "person"
    elif needed[cause] < _NEEDED:
        fast = bool((ego.speed[part] > road.free[part] + _OVER).any())
        cause = "bend or limit" if fast else "nothing"
    if cause == "stop":
        place = float(ego.stop_gap[part].min())
        at_light = abs(place - float(road.line[part].min())) <= _AT
        cause = "light" if at_light else "yielding"
    return {
        "time": float(ego.time[k]),
        "after": float(ego.time[k] - ego.time[0]),
        "deceleration": float(-ego.acceleration[part].min()),
        "speed": float(ego.speed[k]),
        "cause": cause,
    }


def _needed(speed: Floats, other: Floats | float, gap: Floats) -> float:
    """Return the largest deceleration [m/s^2] that gaps [m] to obstacles require."""
    excess = np.maximum(speed**2 - np.square(other), 0.0)
    return float((excess / (2.0 * np.maximum(gap, 0.3))).max())


def _leader_speed(drive: Drive, part: slice) -> Floats:
    """Return the speeds [m/s] of the vehicle ahead, by how its gap changes."""
    ego = drive.ego
    begin = max(part.start - 1, 0)
    rear = (ego.position + ego.vehicle_gap)[begin : part.stop]
    step = np.diff(ego.time[begin : part.stop])
    with np.errstate(invalid="ignore"):
        speeds = np.diff(rear) / step
    speeds = np.where(np.isfinite(speeds) & (np.abs(speeds) < 40.0), np.maximum(speeds, 0.0), 0.0)
    missing = len(ego.time[part]) - len(speeds)
    return np.concatenate([np.zeros(missing), speeds])


def _stands(road: _Road) -> list[dict[str, Any]]:
    """Return the long stands with the body on a crossing or in a junction."""
    drive, ego, found = road.drive, road.drive.ego, list[dict[str, Any]]()
    places = [("crossing", area.entry, area.leave, ()) for area in areas_of(drive)]
    places += [
        ("junction", one.entry + _GRID, one.exit + drive.shape.length, one.waiting)
        for one in drive.way.junctions
    ]
    for begin, end in runs(ego.speed < drive.stop_speed):
        front = float(road.front[begin:end].mean())
        duration = float(ego.time[min(end, len(ego.time) - 1)] - ego.time[begin])
        on = [
            kind
            for kind, entry, leave, waiting in places
            if entry < front < leave and not any(-_AT <= front - place <= 1.0 for place in waiting)
        ]
        if on and duration >= LONG_STAND:
            causes = Counter(ego.waits_for[begin:end].tolist())
            found.append(
                {
                    "time": float(ego.time[begin]),
                    "duration": duration,
                    "on": on[0],
                    "waits_for": causes.most_common(1)[0][0],
                }
            )
    return found


def _gaps_at_rest(drive: Drive) -> list[float]:
    """Return the gap [m] to the vehicle ahead at the end of each stand behind one."""
    ego, found = drive.ego, list[float]()
    for begin, end in runs(ego.speed < drive.stop_speed):
        behind = ego.waits_for[begin:end] == "vehicle"
        gaps = ego.vehicle_gap[begin:end][behind]
        if len(gaps) and ego.time[end - 1] - ego.time[begin] >= 1.0:
            found.append(float(np.median(gaps)))
    return found


def _fault(ego: EgoResult, other: str, first: float) -> str:
    """Return "ego" if the ego drove into another vehicle, else "other".

    It did if it moved, and the other vehicle's middle was ahead of its own middle, unless that
    vehicle came from beside it within the last second.
    """
    track, background = ego.track, ego.background
    k = min(int(np.searchsorted(track.time, first)), len(track.time) - 1)
    if track.speed[max(k - 1, 0)] < 0.3:
        return "other"
    rows = np.flatnonzero(background.id == other)
    rows = rows[np.abs(background.time[rows] - first) <= 1.0 + 1e-6]
    aside, ahead = list[float](), list[float]()
    for i in rows.tolist():
        j = min(int(np.searchsorted(track.time, background.time[i])), len(track.time) - 1)
        c, s = np.cos(track.heading[j]), np.sin(track.heading[j])
        back = background.length[i] / 2.0
        d_x = background.x[i] - back * np.cos(background.heading[i]) - track.front_x[j]
        d_y = background.y[i] - back * np.sin(background.heading[i]) - track.front_y[j]
        if background.time[i] <= first + 1e-6:
            aside.append(abs(d_y * c - d_x * s) - (ego.shape.width + background.width[i]) / 2.0)
            ahead.append(d_x * c + d_y * s)
    if not ahead or ahead[-1] < -ego.shape.length / 2.0:
        return "other"
    return "other" if aside[0] > 0.0 and ahead[0] < background.length[rows[0]] else "ego"


def _slow_share(road: _Road) -> float:
    """Return the share of the driving time in which the ego is slow although the way is free."""
    ego = road.drive.ego
    free = (ego.vehicle_gap > FREE_GAP) & (road.line > road.braking + FREE_LINE)
    lasting = _lasting(ego.time)
    return float(lasting[free & (ego.speed < SLOW)].sum() / max(lasting.sum(), 1e-9))


def _slow_share_of(plain: PlainDrive | None, road: _Road) -> float:
    """Return the same share of SUMO's drive, or nan without one."""
    if plain is None or len(plain.time) < 2:
        return nan
    drive = road.drive
    stations = drive.way.departure + plain.position
    if plain.arrived:
        scale = min(drive.goal, drive.path.length) / max(float(plain.position[-1]), 1.0)
        stations = drive.way.departure + plain.position * scale
    driven = stations <= drive.end
    lines = np.array([inf, *(one.station for one in drive.way.lines)])
    off = lines - stations[:, None]
    line = np.where(off >= 0.0, off, inf).min(axis=1)
    braking = plain.speed**2 / (2.0 * COMFORTABLE)
    free = (plain.vehicle_gap > FREE_GAP) & (line > braking + FREE_LINE)
    lasting = _lasting(plain.time) * driven
    return float(lasting[free & (plain.speed < SLOW)].sum() / lasting.sum())


def _time_lost(road: _Road) -> dict[str, float]:
    """Return the time [s] lost against driving at the limit, by its cause."""
    ego, speed = road.drive.ego, road.drive.ego.speed
    lost = _lasting(ego.time) * np.clip(1.0 - speed / road.limit, 0.0, 1.0)
    reach = road.braking + FREE_LINE
    stop_at_line = np.abs(ego.stop_gap - road.line) <= _AT
    crossings = [area.entry for area in areas_of(road.drive)]
    at_crossing = np.zeros(len(speed), dtype=np.bool_)
    for entry in crossings:
        at_crossing |= np.abs(road.front + ego.stop_gap - entry) <= _AT
    layer = (ego.controller == "safety") & (ego.reason != VehicleLayer.REASON)
    stops = (ego.stop_gap <= reach) & ~stop_at_line
    causes = {
        "people": (ego.gap <= reach) | layer | np.isin(ego.waits_for, ("person", "plan")),
        "following": ego.vehicle_gap <= 4.0 + 2.0 * speed,
        "lights": road.red & (road.line <= reach),
        "yielding": stops,
        "bends": road.free < 0.95 * road.limit,
        "far lights": road.red & (road.line <= 200.0) & (speed < 0.9 * road.limit),
    }
    causes["people"] |= stops & at_crossing & np.isin(ego.waits_for, ("", "yield"))
    names = np.full(len(speed), "other", dtype=object)
    for name, there in reversed(causes.items()):
        names[there] = name
    names[(names == "other") & (ego.acceleration > 0.3)] = "starting"
    return {name: float(lost[names == name].sum()) for name in LOST}


def _lasting(time: Floats) -> Floats:
    """Return the time [s] for which each instant stands."""
    return np.append(np.diff(time), 0.0)
