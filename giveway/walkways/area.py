"""The walkable area of a network as polygons, and its edge as walls."""

from collections import defaultdict

import numpy as np
import shapely

from giveway.walkways.gates import Array
from giveway.walkways.inside import polygon_of, rings
from giveway.walkways.reading import PedLane, Survey

_GAP = 0.15  # Half width [m] of the gaps between neighbours that are closed
_SLIVER = 0.1  # Half width [m] of narrow spits that are cut off
_SMALLEST = 0.5  # Size [m²] below which a hole gets no wall
_SIMPLE = 0.02  # Tolerance [m] of the simplified outline
_ASIDE = 0.5  # Distance [m] beside a crossing's marking, to which people evade one another
_OVERLAP = 0.6  # Length [m] by which a crossing reaches into the walkingareas at its ends

# Distance [m] behind a crossing to which people evade one another and vehicles, where no vehicle
# waits for them. netconvert's walkingareas often meet only a corner of its end; own choice.
_BEHIND = 4.0


def walkable_area(survey: Survey) -> shapely.MultiPolygon:
    """Return the area of lanes, walkingareas, crossings, and junctions without these."""
    parts = [_lane(edge.lane) for edge in survey.edges.values()]
    gaps = {link.target for link in survey.links if not link.priority}
    parts += [
        _lane(lane, _BEHIND if name in gaps else _OVERLAP, _ASIDE)
        for name, lane in survey.crossings.items()
    ]
    parts += [polygon_of(area) for area in survey.walkingareas.values()]
    parts += _bare_junctions(survey)
    return _joined(parts)


def sidewalk_area(survey: Survey, place: shapely.Geometry) -> shapely.MultiPolygon:
    """Return the sidewalks and walkingareas that reach into a place, without roadways."""
    parts = [_lane(edge.lane) for edge in survey.edges.values() if edge.sidewalk]
    parts += [polygon_of(area) for area in survey.walkingareas.values()]
    return _joined([part for part in parts if part.intersects(place)])


def _joined(parts: list[shapely.Geometry]) -> shapely.MultiPolygon:
    """Return the union of the parts, with gaps closed and spits cut off."""
    closed = shapely.union_all(parts).buffer(_GAP, join_style="mitre")
    opened = closed.buffer(-_GAP - _SLIVER, join_style="mitre")
    area = opened.buffer(_SLIVER, join_style="mitre").simplify(_SIMPLE)
    polygons = [
        shapely.Polygon(p.exterior, [h for h in p.interiors if shapely.Polygon(h).area > _SMALLEST])
        for p in getattr(area, "geoms", [area])
        if p.area > _SMALLEST
    ]
    return shapely.MultiPolygon(polygons)


def walls(area: shapely.MultiPolygon) -> Array:
    """Return an area's rings as segments (k, 4) x0, y0, x1, y1 [m], the area on their left."""
    segments = [np.empty((0, 4))]
    for polygon in area.geoms:
        segments += [np.hstack([ring[:-1], ring[1:]]) for ring in rings(polygon)]
    return np.ascontiguousarray(np.vstack(segments))


def _lane(lane: PedLane, extension: float = 0.0, aside: float = 0.0) -> shapely.Geometry:
    """Return the area of a lane, which ends straight ``extension`` [m] beyond its ends.

    Args:
        lane: Lane for people.
        extension: Length [m] that it has beyond its ends.
        aside: Distance [m] to either side that it is wider.
    """
    points = lane.shape
    if extension:
        first, last = points[0] - points[1], points[-1] - points[-2]
        points = np.vstack(
            [
                points[0] + extension * first / np.hypot(*first),
                points[1:-1],
                points[-1] + extension * last / np.hypot(*last),
            ]
        )
    line = shapely.LineString(points)
    return line.buffer(lane.width / 2 + aside, cap_style="flat", join_style="mitre")


def _bare_junctions(survey: Survey) -> list[shapely.Geometry]:
    """Return the outlines of junctions at which a lane ends and no walkingarea begins."""
    served = {(link.source, True) for link in survey.links}
    served |= {(link.target, False) for link in survey.links}
    bare: dict[str, list[Array]] = defaultdict(list)
    for name, edge in survey.edges.items():
        for last in (False, True):
            if (name, last) not in served:
                bare[edge.junctions[last]].append(_end(edge.lane, last))
    outlines = survey.junctions
    hulls = [
        np.vstack([*ends, outlines.get(name, ends[0])])
        for name, ends in bare.items()
        if len(ends) > 1  # people walk on only where two lanes meet
    ]
    return [shapely.MultiPoint(points).convex_hull for points in hulls]


def _end(lane: PedLane, last: bool) -> Array:
    """Return the two corners (2, 2) [m] of a lane at one of its ends."""
    end, inner = lane.shape[[-1, -2]] if last else lane.shape[[0, 1]]
    along = (end - inner) / max(float(np.hypot(*(end - inner))), 1e-9)
    across = lane.width / 2 * np.array([-along[1], along[0]])
    return np.stack([end - across, end + across])
