"""The walkable area and its walls: closed, the right way round, and across nobody's way."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from giveway.walkways import WalkNetwork

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from giveway.walkways import WalkRoute

NAMES = ["grid", "spider", "random", "bare"]


def beside(walls: NDArray[np.float64], distance: float) -> NDArray[Any]:
    """The points ``distance`` [m] to the left of the middle of each wall."""
    start, end = walls[:, :2], walls[:, 2:]
    along = (end - start) / np.hypot(*(end - start).T)[:, None]
    left = np.column_stack([-along[:, 1], along[:, 0]])
    return np.asarray(shapely.points((start + end) / 2 + distance * left))


@pytest.mark.parametrize("name", NAMES)
def test_the_walkable_side_is_on_the_left(built: Callable[[str], Any], name: str) -> None:
    network = built(name).network
    walls, area = network.wall_segments, network.walkable
    assert len(walls) > 30
    assert shapely.contains(area, beside(walls, 0.02)).all()
    assert not shapely.contains(area, beside(walls, -0.02)).any()
    long = walls[np.hypot(*(walls[:, 2:] - walls[:, :2]).T) > 1.0]
    assert shapely.contains(area, beside(long, 0.2)).all()


@pytest.mark.parametrize("name", NAMES)
def test_walls_are_closed_rings_round_the_whole_area(
    built: Callable[[str], Any], name: str
) -> None:
    network = built(name).network
    walls = network.wall_segments
    np.testing.assert_array_equal(np.unique(walls[:, :2], axis=0), np.unique(walls[:, 2:], axis=0))
    (x_0, y_0, x_1, y_1) = walls.T
    signed = ((x_0 * y_1 - x_1 * y_0) / 2).sum()  # Gauss: positive counter-clockwise
    assert signed == pytest.approx(network.walkable.area, rel=1e-9)
    assert network.walkable.is_valid


@pytest.mark.parametrize("name", NAMES)
def test_all_lanes_and_areas_lie_inside(built: Callable[[str], Any], name: str) -> None:
    network = built(name).network
    room = network.walkable.buffer(0.05)
    survey = network._survey
    lanes = [edge.lane for edge in survey.edges.values()] + list(survey.crossings.values())
    assert shapely.covers(room, [shapely.LineString(lane.shape) for lane in lanes]).all()
    outlines = [shapely.Polygon(area.shape) for area in survey.walkingareas.values()]
    outside = sum(outline.difference(room).area for outline in outlines if outline.is_valid)
    assert outside < 1e-3 * network.walkable.area


def test_no_wall_stands_in_the_roadway_between_two_sidewalks(grid: WalkNetwork) -> None:
    """Blocks and roadways are left out: 12 two-way streets with 2 m on either side."""
    area = grid.walkable
    assert not area.contains(shapely.Point(60.0, 120.0))  # the road
    assert not area.contains(shapely.Point(60.0, 60.0))  # the houses
    assert area.contains(shapely.Point(60.0, 120.0 - 4.2))  # the sidewalk
    assert not area.contains(shapely.Point(120.0, 120.0))  # the middle of the junction
    assert area.contains(shapely.Point(120.0, 120.0 - 4.0))  # a crossing


def test_without_walkingareas_junctions_are_walkable(bare: WalkNetwork) -> None:
    assert bare.walkable.contains(shapely.Point(120.0, 120.0))
    assert len(bare.walkable.geoms) == 1


TOWN = """<net>
    <edge id="a" from="1" to="2">
        <lane id="a_0" allow="pedestrian" length="20" width="2" shape="0,0 20,0"/>
    </edge>
    <edge id=":2_w0" function="walkingarea">
        <lane id=":2_w0_0" allow="pedestrian" length="5" width="2" shape="{outline}"/>
    </edge>
    <edge id="b" from="2" to="3">
        <lane id="b_0" allow="pedestrian" length="20" width="2" shape="25,0 45,0"/>
    </edge>
    <connection from="a" to=":2_w0" fromLane="0" toLane="0" dir="s" state="M"/>
    <connection from=":2_w0" to="b" fromLane="0" toLane="0" dir="s" state="M"/>
</net>"""


@pytest.fixture
def town(tmp_path: Path) -> Callable[[str], WalkNetwork]:
    """Two sidewalks and a walkingarea of the outline that one gives."""

    def read(outline: str) -> WalkNetwork:
        (tmp_path / "town.net.xml").write_text(TOWN.format(outline=outline))
        return WalkNetwork.read(tmp_path / "town.net.xml")

    return read


def test_hairline_gaps_are_closed(town: Callable[[str], WalkNetwork]) -> None:
    area = town("20.1,-1 24.9,-1 24.9,1 20.1,1").walkable
    assert len(area.geoms) == 1
    assert area.area == pytest.approx(45 * 2, abs=0.1)
    assert len(town("20.1,-1 24.9,-1 24.9,1 20.1,1").wall_segments) == 4


def test_an_outline_that_crosses_itself_stays_passable(town: Callable[[str], WalkNetwork]) -> None:
    network = town("20,-1 25,1 25,-1 20,1")  # a bow-tie: no width in the middle
    assert len(network.walkable.geoms) == 1
    route = network.route(["a", "b"], position=(5.0, 0.0), lane="a_0", arrival_position=10.0)
    line = shapely.LineString([(5.0, 0.0), *route.waypoints])
    assert network.walkable.buffer(0.05).covers(line)


@pytest.mark.parametrize("outline", ["22.5,0", "20,0 25,0", "20,0 22,0 25,0"])
def test_an_outline_without_area_is_as_wide_as_its_lane(
    town: Callable[[str], WalkNetwork], outline: str
) -> None:
    network = town(outline)
    assert network.walkable.contains(shapely.Point(22.5, 0.9))
    route = network.route(["a", "b"], position=(5.0, 0.0), lane="a_0", arrival_position=10.0)
    assert route.gaps == 0


def test_the_way_goes_round_a_corner_and_not_through_the_house(
    town: Callable[[str], WalkNetwork],
    walked: Callable[[WalkRoute, tuple[float, float]], shapely.LineString],
) -> None:
    network = town("20,-1 25,-1 25,1 24,1 24,-0.2 21,-0.2 21,1 20,1")  # a house in the north
    for side in (-1.0, 0.0, 1.0):
        route = network.route(
            ["a", "b"], position=(5.0, 0.73 * side), lane="a_0", arrival_position=10.0
        )
        line = walked(route, (5.0, 0.73 * side))
        assert network.walkable.buffer(0.1).covers(line)
    walls = network.wall_segments.reshape(-1, 2, 2)
    assert not shapely.crosses(shapely.linestrings(walls), line).any()
