"""People whose way leads off the walkways wait before its edge, and then walk on."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from giveway.crowd.impasses import Impasses
from giveway.crowd.roster import Roster
from giveway.walkways.area import walls
from pedestrian_model import PRESETS, Crowd, CrowdModel, Surroundings, Vehicles, Walls

NORTH, SOUTH = shapely.box(0, 4, 30, 6), shapely.box(0, -6, 30, -4)  # sidewalks, a road between
AREA = shapely.MultiPolygon([NORTH, SOUTH])
STEP = 0.05  # [s]


def walk(crowd: Crowd, duration: float, *, lets: bool, closed: bool = False) -> np.ndarray:
    """Return the positions (k, n, 2) [m] of a crowd, once a second."""
    around = Surroundings(Walls.create(walls(AREA)), np.array([closed]))
    roster = Roster()
    roster.take_in([f"p{i}" for i in range(len(crowd))], crowd)
    impasses = Impasses(roster, around, AREA)
    model, track = CrowdModel(PRESETS["MIXED"]), []
    for step in range(round(duration / STEP)):
        if lets and step % 4 == 0:
            impasses.update(step * STEP)
        model.advance(roster.crowd, Vehicles.empty(), around)
        if step % 20 == 0:
            track.append(roster.crowd.position.copy())
    return np.array(track)


def over_the_road(signal: int = -1) -> Crowd:
    """Return a person on the northern sidewalk who has to get to the southern one."""
    route, lights = [[(20.0, 5.0), (20.0, -5.0)]], [[-1, signal]]
    return Crowd.create([(10.0, 5.0)], [(1.3, 0.0)], 1.3, route, signals=lights)


def test_a_way_over_the_road_is_walked_after_a_look() -> None:
    held = walk(over_the_road(), 40.0, lets=False)
    assert held[:, 0, 1].min() > 4.0
    gone = walk(over_the_road(), 40.0, lets=True)[:, 0, 1]
    assert gone[-1] == pytest.approx(-5.0, abs=0.6)
    assert (gone[:13] > 4.0).all()  # 10 m to the corner, and 5 s there
    assert (gone[20:] < 4.0).all()


def test_who_waits_for_green_stays_on_the_sidewalk() -> None:
    assert walk(over_the_road(signal=0), 40.0, lets=True, closed=True)[:, 0, 1].min() > 4.0


def test_who_makes_progress_along_a_wall_is_held_by_it() -> None:
    """People who walk abreast on a narrow sidewalk do not get a way of their own."""
    n = 12
    start = [(0.5 + 0.7 * (i // 3), 4.5 + 0.5 * (i % 3)) for i in range(n)]
    crowd = Crowd.create(start, np.tile((1.3, 0.0), (n, 1)), 1.3, [[(29.0, 5.0)]] * n)
    track = walk(crowd, 20.0, lets=True)
    assert shapely.contains_xy(NORTH, track[..., 0], track[..., 1]).all()
    assert track[-1, :, 0].min() > 18.0
