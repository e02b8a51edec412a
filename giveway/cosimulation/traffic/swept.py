"""The places beside crossings that cars sweep as they turn.

A car that turns cuts the inner corner: the middle of its body keeps to the inside of the line that
its front follows, by more than half a metre in a tight turn. A kerb may be within this strip.
"""

import numpy as np
import shapely

from giveway.geometry.kernel import Array
from giveway.geometry.path import points_at, stations_of
from giveway.sumo.network.junction_links import Movement
from giveway.sumo.session import SumoSession

_LENGTH, _WIDTH = 4.5, 1.8  # length and width [m] of a car
_BODY = 0.4  # distance [m] between a car's side and a person's middle: half a body and 0.13 m
_NEAR = 3.0  # distance [m] to a kerb within which the cars' places count
_APART = 0.5  # distance [m] between the places of a car


def swept_near(session: SumoSession, kerbs: Array, sidewalks: shapely.Geometry) -> shapely.Geometry:
    """Return where people's middles must not be as cars turn near kerbs.

    Args:
        session: The running simulation.
        kerbs: Middles (n, 2) [m] of kerbs, where people wait.
        sidewalks: Places on which people wait.
    """
    places = shapely.MultiPoint(kerbs).buffer(_NEAR)
    reach = places.buffer(_WIDTH)
    places &= sidewalks
    shapely.prepare((places, reach))
    bodies = [shapely.Polygon()]
    for movement in session.junctions.beside(session.lanes.crossings):
        line = _way(session, movement)
        if reach.intersects(shapely.LineString(line)):
            bodies += _bodies(line, reach, places)
    return shapely.union_all(bodies)


def _way(session: SumoSession, movement: Movement) -> Array:
    """Return the line (k, 2) [m] of a movement, from a car's length before the junction on."""
    before, behind = (session.lanes.shape(lane) for lane in (movement.source, movement.target))
    back = before[::-1]
    back = points_at(back, stations_of(back), np.array([_LENGTH, 0.0]))
    on = points_at(behind, stations_of(behind), np.array([0.0, 2.0 * _LENGTH]))
    return np.concatenate([back, *map(session.lanes.shape, movement.inside), on])


def _bodies(
    line: Array, reach: shapely.Geometry, places: shapely.Geometry
) -> list[shapely.Geometry]:
    """Return the bodies of cars on a line, with room for people, that are on some places."""
    along = stations_of(line)
    fronts = np.arange(_LENGTH, along[-1], _APART)
    ends = np.stack([points_at(line, along, fronts - _LENGTH), points_at(line, along, fronts)], 1)
    axes = shapely.linestrings(ends)
    axes = axes[reach.intersects(axes)]
    bodies = shapely.buffer(axes, _WIDTH / 2.0 + _BODY, cap_style="flat")
    return list(bodies[places.intersects(bodies)])
