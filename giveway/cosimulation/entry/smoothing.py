"""The smooth path of an ego: corners of its lanes' polyline are rounded where they cost speed."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from giveway.config.option import LANE
from giveway.ego.rules.speed_profile import in_bends, of_lanes
from giveway.ego.waiting_ego import WaitingEgo
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import EgoPath
from giveway.geometry.smoothing import SmoothPath, smooth
from giveway.sumo.network.lane_path import LanePath, LaneWidth

_SPACING = 0.5  # Distance [m] between the places that are examined
_REACH = 60.0  # Length [m] before and behind a bend on which the path may leave the polyline
_FARTHEST = 0.49  # Largest distance [m] from the polyline; the bound holds to 1 cm
_LEAST = 0.05  # Least room [m], in lanes that are narrower than the vehicle needs
_MARGIN = 0.1  # Distance [m] that the body keeps to the edge of its lane


def smoothed(
    ego: WaitingEgo,
    path: EgoPath,
    lane_path: LanePath,
    departure: float,
    shape: VehicleShape,
    fastest: float = math.inf,
) -> tuple[EgoPath, LanePath]:
    """Return the path and the lane path with smooth bends ahead of the departure.

    Both stay as they are if no bend slows the ego down, or if it does not heed speed limits.

    Args:
        ego: Ego before its departure.
        path: Path of the ego.
        lane_path: Lanes that the path was made of.
        departure: Station [m] of the front bumper.
        shape: Length and width of its body.
        fastest: Highest speed [m/s] of the vehicle.
    """
    config = ego.config
    if not config.heeds("speed_limits") or not lane_path.limits:
        return path, lane_path
    wanted = math.inf if config.reference_speed == LANE else float(config.reference_speed)
    stations: Array = np.arange(0.0, path.length, _SPACING)
    limits = np.minimum(
        of_lanes(lane_path.limits, stations), min(wanted, fastest, config.vehicle.speed_max)
    )
    slow = stations[in_bends(path, shape.length, stations) < limits]
    parts = _parts(slow, departure, path.length)
    if not parts:
        return path, lane_path
    free = partial(_free, lane_path.widths, shape)
    # How far the body's middle is aside depends on the smooth path, hence the second pass
    first = smooth(path, parts, lambda at: (path.points(at), np.minimum(free(at), _FARTHEST)))
    found = smooth(path, parts, lambda at: _room(path, first, shape.length, at, free(at)))
    return found.path, lane_path.moved(found.path.vertices, found.station)


def _parts(slow: Array, begin: float, end: float) -> list[tuple[float, float]]:
    """Return the intervals of stations [m] within reach of the stations ``slow`` (k,) [m]."""
    parts: list[tuple[float, float]] = []
    for station in slow.tolist():
        first, last = max(begin, station - _REACH), min(end, station + _REACH)
        if parts and first <= parts[-1][1]:
            first = parts.pop()[0]
        if last > begin:
            parts.append((first, last))
    return parts


def _free(widths: Sequence[LaneWidth], shape: VehicleShape, stations: Array) -> Array:
    """Return the distances (n,) [m] to either side that the lanes at ``stations`` (n,) allow."""
    width = np.full(len(stations), math.inf)
    begins = [each.station for each in widths]
    for each, end in zip(widths, [*begins[1:], math.inf], strict=True):
        own = (stations > each.station - shape.length) & (stations < end + shape.length)
        width[own] = np.minimum(width[own], each.width)
    free: Array = np.maximum((width - shape.width) / 2.0 - _MARGIN, _LEAST)
    return free


def _room(
    path: EgoPath, smooth_path: SmoothPath, length: float, stations: Array, free: Array
) -> tuple[Array, Array]:
    """Return the circles in which the front's middle keeps the body inside its lane.

    In a bend the middle of the body is nearer to the inner edge than its front and rear are, so
    that there is less room inwards than outwards.

    Args:
        path: Polyline.
        smooth_path: Smooth path, by which the body is expected to turn.
        length: Length of the body [m].
        stations: Stations (n,) [m] on the polyline.
        free: Distances (n,) [m] to either side that the lanes allow.

    Returns:
        centres: Centres (n, 2) [m].
        radii: Radii (n,) [m].
    """
    bent, half = smooth_path.path, length / 2.0
    at = np.interp(stations, smooth_path.before, smooth_path.after)
    sag = bent.points(at) - (bent.points(at + half) + bent.points(at - half)) / 2.0
    sag[(at < half) | (at > bent.length - half)] = 0.0
    inwards = np.hypot(*sag.T)
    outer = np.minimum(free, _FARTHEST)
    inner = np.clip(free - inwards, _LEAST, _FARTHEST)
    aside = (outer - inner) / 2.0 / np.maximum(inwards, 1e-9)
    return path.points(stations) + aside[:, None] * sag, (outer + inner) / 2.0
