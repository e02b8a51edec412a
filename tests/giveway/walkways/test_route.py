"""Ways on the made-up grid: sides, ends, signals, and people who are already inside a junction.

A2 --- B2 --- C2      120 m from junction to junction, two-way streets with a sidewalk 2 m
|      |      |       wide on the right of each direction, crossings with traffic lights on
A1 --- B1 --- C1      all arms. Edge A1B1 runs east; its sidewalk is south of the road.
|      |      |
A0 --- B0 --- C0
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.giveway.walkways.conftest import kerb_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from giveway.walkways import WalkNetwork, WalkRoute

AVENUE = ["A1B1", "B1C1"]  # eastwards through B1


def walk(
    network: WalkNetwork,
    edges: list[str],
    *,
    position: tuple[float, float] | None = None,
    lane: str | None = None,
    arrival: float = 50.0,
    side: float | None = 0.0,
) -> WalkRoute:
    """A way from 20 m along the first edge, unless told otherwise."""
    if position is None:
        position = on(network, edges[0], 20.0)
    return network.route(
        edges,
        position=position,
        lane=lane or f"{edges[0]}_0",
        arrival_position=arrival,
        offset_side=side,
    )


def on(network: WalkNetwork, edge: str, metres: float, left: float = 0.0) -> tuple[float, float]:
    """A place on the (straight) lane of an edge."""
    lane = network._survey.edges[edge].lane
    (x_0, y_0), (x_1, y_1) = lane.shape[[0, -1]]
    length = math.dist((x_0, y_0), (x_1, y_1))
    d_x, d_y = (x_1 - x_0) / length, (y_1 - y_0) / length
    return x_0 + metres * d_x - left * d_y, y_0 + metres * d_y + left * d_x


def length(route: WalkRoute, position: tuple[float, float]) -> float:
    return float(np.hypot(*np.diff(np.vstack([position, route.waypoints]), axis=0).T).sum())


# --- ends and directions ---------------------------------------------------------------------


@pytest.mark.parametrize(("arrival", "metres"), [(50.0, 50.0), (-10.0, None), (0.0, 0.0)])
def test_a_walk_ends_where_sumo_says(
    grid: WalkNetwork, arrival: float, metres: float | None
) -> None:
    lane = grid._survey.edges["B1C1"].lane
    goal = on(grid, "B1C1", lane.length - 10.0 if metres is None else metres)
    route = walk(grid, AVENUE, arrival=arrival)
    np.testing.assert_allclose(route.waypoints[-1], goal, atol=1e-9)
    assert route.gaps == 0


def test_positions_are_stretched_as_sumo_stretches_them(grid: WalkNetwork) -> None:
    lane = grid._survey.edges["B1C1"].lane
    assert math.dist(*lane.shape[[0, -1]]) != pytest.approx(lane.length / 2)
    route = walk(grid, ["B1C1"], arrival=lane.length / 2)
    np.testing.assert_allclose(route.waypoints[-1], lane.shape.mean(axis=0), atol=1e-9)


@pytest.mark.parametrize("arrival", [5.0, 90.0])
def test_on_a_single_edge_one_walks_towards_the_end_of_the_walk(
    grid: WalkNetwork, arrival: float
) -> None:
    route = walk(grid, ["A1B1"], arrival=arrival)
    assert len(route.waypoints) == 1
    assert route.passages[0, 0] == pytest.approx(math.copysign(1.0, arrival - 20.0))


def test_the_junction_that_edges_share_gives_the_direction(grid: WalkNetwork) -> None:
    against = walk(grid, ["C1B1", "B1A1"])  # along both
    np.testing.assert_allclose(against.passages[-1, :2], [-1.0, 0.0], atol=1e-9)
    backwards = walk(grid, ["B1A1", "C1B1"])  # against both: eastwards on the northern side
    np.testing.assert_allclose(backwards.passages[-1, :2], [1.0, 0.0], atol=1e-9)


@pytest.mark.parametrize(("metres", "turns_at"), [(15.0, "A1"), (90.0, "B1")])
def test_to_the_other_side_one_crosses_at_the_nearer_junction(
    grid: WalkNetwork, metres: float, turns_at: str
) -> None:
    route = walk(grid, ["A1B1", "B1A1"], position=on(grid, "A1B1", metres), arrival=105.0 - metres)
    crossed = {grid.signals[i].tls for i in route.signals if i >= 0}
    assert crossed == {turns_at}


def test_an_edge_named_twice_is_walked_once(grid: WalkNetwork) -> None:
    twice = walk(grid, ["A1B1", "A1B1", "B1C1"])
    np.testing.assert_array_equal(twice.waypoints, walk(grid, AVENUE).waypoints)


def test_crossings_and_walkingareas_among_edges_change_nothing(grid: WalkNetwork) -> None:
    named = walk(grid, ["A1B1", ":B1_w3", ":B1_c2", ":B1_w2", "B1C1"])
    np.testing.assert_array_equal(named.waypoints, walk(grid, AVENUE).waypoints)


def test_edges_behind_are_left_out(grid: WalkNetwork) -> None:
    position = on(grid, "B1C1", 10.0)
    route = walk(grid, ["A1B1", "B1C1"], position=position, lane="B1C1_0")
    np.testing.assert_allclose(route.waypoints, [on(grid, "B1C1", 50.0)], atol=1e-9)


# --- sides -----------------------------------------------------------------------------------


@pytest.mark.parametrize("edge", ["A1B1", "B1A1", "B0B1", "B1B0"])
@pytest.mark.parametrize("arrival", [5.0, 60.0])
@pytest.mark.parametrize("left", [-0.9, 0.0, 0.73])
def test_lines_reach_from_border_to_border_and_not_beyond(
    grid: WalkNetwork, edge: str, arrival: float, left: float
) -> None:
    # Somebody aims at the nearest point of the line, wherever it is crossed: with a line that
    # reached over the border, whoever was pushed off the sidewalk would walk on beside it.
    route = walk(grid, [edge], position=on(grid, edge, 20.0, left), arrival=arrival, side=None)
    middle = on(grid, edge, arrival)
    np.testing.assert_allclose(route.waypoints, [middle], atol=1e-9)
    assert route.passages[0, 2] == pytest.approx(1.0)  # half of a sidewalk


# --- signals ---------------------------------------------------------------------------------


def test_one_waits_on_the_kerb_for_each_crossing_on_the_way(grid: WalkNetwork) -> None:
    route = walk(grid, AVENUE)
    waits = np.flatnonzero(route.signals >= 0)
    assert len(waits) == 1
    wait = waits[0]
    assert grid.signals[route.signals[wait]].tls == "B1"
    # The road from B0 is 6.4 m wide; one waits 0.4 m before it and then crosses it eastwards.
    assert route.waypoints[wait, 0] == pytest.approx(120.0 - 3.2 - 0.4)
    assert route.waypoints[wait + 1, 0] == pytest.approx(120.0 + 3.2 + 0.4)
    np.testing.assert_allclose(route.passages[wait, :2], [1.0, 0.0], atol=1e-9)


def test_no_crossing_no_signal(grid: WalkNetwork) -> None:
    route = walk(grid, ["A1B1", "B1B0"])  # round the corner on the same side
    assert (route.signals == -1).all()
    assert route.gaps == 0


def test_both_directions_of_a_crossing_obey_its_light(grid: WalkNetwork) -> None:
    east, west = walk(grid, AVENUE), walk(grid, ["B1C1", "A1B1"])
    east_signal, west_signal = max(east.signals), max(west.signals)
    assert east_signal == west_signal >= 0
    crossed_westwards = west.waypoints[np.argmax(west.signals >= 0)]
    assert crossed_westwards[0] == pytest.approx(120.0 + 3.2 + 0.4)


def test_without_lights_people_wait_for_a_gap_or_have_priority(built: Callable[[str], Any]) -> None:
    network = built("random").network
    lit = {signal.crossing for signal in network.signals}
    dark = next(c for c in network._survey.crossings if c not in lit)
    assert dark in network.gap_crossings
    links = network._survey.links
    before = next(link.source for link in links if link.target == dark)
    after = next(link.target for link in links if link.source == dark)
    lanes = [_lane_beside(network, area) for area in (before, after)]
    route = walk(network, lanes)
    number = len(network.signals) + network.gap_crossings.index(dark)
    assert set(route.signals) == {-1, number}
    assert route.gaps == 0


def _lane_beside(network: WalkNetwork, area: str) -> str:
    """An edge whose sidewalk ends or begins at a walkingarea."""
    pairs = [{link.source, link.target} for link in network._survey.links]
    ends = [edge for pair in pairs if area in pair for edge in sorted(pair)]
    return next(edge for edge in ends if edge in network._survey.edges)


# --- already inside a junction ---------------------------------------------------------------


def test_who_is_on_a_crossing_goes_on_without_waiting(grid: WalkNetwork) -> None:
    crossing = grid.signals[max(walk(grid, AVENUE).signals)].crossing
    position = (118.0, 114.8)
    route = walk(grid, AVENUE, position=position, lane=f"{crossing}_0", side=None)
    assert (route.signals == -1).all()
    assert route.gaps == 0
    assert (np.diff(np.concatenate([[position[0]], route.waypoints[:, 0]])) > 0).all()


def test_on_the_way_back_a_crossing_is_left_at_its_other_end(grid: WalkNetwork) -> None:
    crossing = grid.signals[max(walk(grid, AVENUE).signals)].crossing
    position = (118.0, 114.8)
    route = walk(grid, ["B1C1", "A1B1"], position=position, lane=f"{crossing}_0", side=None)
    assert (route.signals == -1).all()
    assert (np.diff(np.concatenate([[position[0]], route.waypoints[:, 0]])) < 0).all()


def test_who_is_in_a_walkingarea_starts_there(grid: WalkNetwork) -> None:
    corner = next(name for name in (f":B1_w{i}" for i in range(4)) if _south_west(grid, name))
    position = (114.5, 115.5)
    route = walk(grid, AVENUE, position=position, lane=f"{corner}_0", side=None)
    assert route.signals[0] >= 0  # at once to the kerb
    assert route.waypoints[0, 0] > position[0]
    assert length(route, position) < 65.0


def test_already_behind_the_crossing_there_is_only_the_lane(grid: WalkNetwork) -> None:
    corner = next(name for name in (f":B1_w{i}" for i in range(4)) if _south_east(grid, name))
    route = walk(grid, AVENUE, position=(125.0, 115.5), lane=f"{corner}_0", side=None)
    assert (route.signals == -1).all()
    assert len(route.waypoints) == 2  # the beginning of the lane, and the end of the walk


def _south_west(network: WalkNetwork, area: str) -> bool:
    return _corner(network, area) == (True, True)


def _south_east(network: WalkNetwork, area: str) -> bool:
    return _corner(network, area) == (False, True)


def _corner(network: WalkNetwork, area: str) -> tuple[bool, bool]:
    """Whether a walkingarea of B1 lies in the west and in the south, by a way through it."""
    x, y = network._survey.walkingareas[area].shape.mean(axis=0)
    return bool(x < 120.0), bool(y < 120.0)


# --- gaps ------------------------------------------------------------------------------------


def test_edges_that_do_not_meet_are_a_gap_and_a_straight_line(grid: WalkNetwork) -> None:
    route = walk(grid, ["A0A1", "C1C2"])
    assert route.gaps == 1
    assert np.isfinite(route.waypoints).all()
    np.testing.assert_allclose(route.waypoints[-1], on(grid, "C1C2", 50.0), atol=1e-9)


def test_unknown_edges_are_gaps(grid: WalkNetwork) -> None:
    assert walk(grid, ["A1B1", "elsewhere", "B1C1"]).gaps == 1
    nowhere = grid.route(["elsewhere"], position=(3.0, 4.0), lane="", arrival_position=0.0)
    assert nowhere.gaps == 1
    np.testing.assert_array_equal(nowhere.waypoints, [[3.0, 4.0]])
    assert grid.route([], position=(3.0, 4.0), lane="", arrival_position=0.0).gaps == 1


def test_without_walkingareas_people_go_straight_over_junctions(bare: WalkNetwork) -> None:
    route = walk(bare, AVENUE)
    assert route.gaps == 0
    assert (route.signals == -1).all()
    y = bare._survey.edges["A1B1"].lane.shape[0, 1]
    np.testing.assert_allclose(route.waypoints[:, 1], y)


def test_in_the_middle_of_such_a_junction_one_goes_on(bare: WalkNetwork) -> None:
    route = walk(bare, AVENUE, position=(121.0, 117.0), lane=":B1_1_0", side=None)
    assert route.gaps == 0
    assert (route.waypoints[:, 0] > 121.0).all()


# --- properties ------------------------------------------------------------------------------

NODES = [f"{column}{row}" for column in "ABC" for row in range(3)]


def neighbours(node: str) -> list[str]:
    column, row = "ABC".index(node[0]), int(node[1])
    around = [(column - 1, row), (column + 1, row), (column, row - 1), (column, row + 1)]
    return [f"{'ABC'[c]}{r}" for c, r in around if 0 <= c < 3 and 0 <= r < 3]


@st.composite
def tours(draw: st.DrawFn) -> list[str]:
    """A walk through the grid by nodes, each street walked on either of its two sidewalks."""
    nodes = [draw(st.sampled_from(NODES))]
    for _ in range(draw(st.integers(2, 6))):
        ahead = [n for n in neighbours(nodes[-1]) if n not in nodes[-2:-1]]
        nodes.append(draw(st.sampled_from(ahead)))
    pairs = itertools.pairwise(nodes)
    return [a + b if draw(st.booleans()) else b + a for a, b in pairs]


@settings(max_examples=150)
@given(edges=tours(), side=st.floats(-1.0, 1.0), arrival=st.floats(0.0, 100.0))
def test_every_way_is_connected_and_stays_where_people_walk(
    grid: WalkNetwork,
    walked: Callable[[WalkRoute, tuple[float, float]], shapely.LineString],
    edges: list[str],
    side: float,
    arrival: float,
) -> None:
    start = on(grid, edges[0], 20.0, 0.73 * side)
    route = walk(grid, edges, position=start, arrival=arrival, side=None)
    assert route.gaps == 0
    assert len(route.waypoints) == len(route.passages) == len(route.signals)
    np.testing.assert_allclose(np.hypot(*route.passages[:, :2].T), 1.0)
    middle = shapely.LineString(np.vstack([on(grid, edges[0], 20.0), route.waypoints]))
    assert grid.walkable.buffer(0.1).covers(middle)
    # The nearest points of the lines round a corner may be its very ends, on the roadway's rim.
    assert grid.walkable.buffer(0.5).covers(walked(route, start))


@settings(max_examples=50)
@given(edges=tours(), side=st.floats(-1.0, 1.0))
def test_one_comes_to_each_line_from_before_it(
    grid: WalkNetwork, edges: list[str], side: float
) -> None:
    route = walk(grid, edges, side=side)
    position = on(grid, edges[0], 20.0)
    steps = np.diff(np.vstack([position, route.waypoints]), axis=0)
    before = (steps * route.passages[:, :2]).sum(axis=1) > 0.0
    lit = route.signals >= 0
    assert (before | lit).all()
    for wait in np.flatnonzero(lit & ~before):  # round a corner to the kerb
        np.testing.assert_allclose(route.passages[wait, :2], kerb_of(grid, route, wait)[1])


@settings(max_examples=50)
@given(
    edges=st.lists(st.sampled_from(["A0A1", "B1B0", "C2C1", "A1B1", "nowhere", ":B1_c0", ""])),
    lane=st.sampled_from(["A0A1_0", ":B1_w0_0", ":B1_c1_0", ":B1_5_0", ":nowhere_0", "", "x"]),
    x=st.floats(-1e4, 1e4),
    y=st.floats(-1e4, 1e4),
    arrival=st.floats(-1e6, 1e6),
)
def test_no_request_fails(
    grid: WalkNetwork, edges: list[str], lane: str, x: float, y: float, arrival: float
) -> None:
    route = grid.route(edges, position=(x, y), lane=lane, arrival_position=arrival)
    assert len(route.waypoints) >= 1
    assert np.isfinite(route.waypoints).all()
    assert np.isfinite(route.passages).all()
