"""The ego's path and the corridor about it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.ego.perception.corridor import Corridor
from giveway.errors import ScenarioError
from giveway.geometry.path import EgoPath, directions, fine_near

L_SHAPE = [(0, 0), (10, 0), (10, 20)]  # 10 m east, then 20 m north


def corridor(points: list[tuple[float, float]], horizon: int = 3) -> Corridor:
    return Corridor(
        EgoPath.through(points),
        half_width=1.25,
        horizon=horizon,
        time_step=0.05,
        walking_speed_limit=2.5,
        body_length=5.0,
    )


def test_stations_near_some_places_leave_out_what_is_between() -> None:
    near = np.array([10.0, 11.0, 500.0])
    stations = fine_near(near, 1.0, 9.0, 500.3, 0.25)
    assert stations == pytest.approx([*np.arange(9.0, 12.01, 0.25), *np.arange(499.0, 500.3, 0.25)])
    every = np.arange(9.0, 500.3, 0.25)
    assert set(stations) <= set(every)  # to the bit


def test_pose_along_an_l_shaped_path() -> None:
    path = EgoPath.through(L_SHAPE)
    assert path.length == 30
    assert path.pose(4) == pytest.approx((4, 0, 0))
    assert path.pose(13) == pytest.approx((10, 3, math.pi / 2))
    assert path.pose(-2) == pytest.approx((-2, 0, 0))
    assert path.pose(31) == pytest.approx((10, 21, math.pi / 2))


def test_projection_gives_station_and_side() -> None:
    path = EgoPath.through(L_SHAPE)
    stations, laterals = path.project([(4, 1), (4, -1), (9, 5), (12, 5), (-3, 1), (10, 25)])
    assert stations == pytest.approx([4, 4, 15, 15, -3, 35])
    assert laterals == pytest.approx([1, -1, 1, -2, 1, 0])


@given(
    st.lists(
        st.tuples(st.floats(-100, 100), st.floats(-100, 100)), min_size=2, max_size=8, unique=True
    ),
    st.floats(0, 1),
)
def test_a_point_of_the_path_has_no_lateral_offset(
    points: list[tuple[float, float]], where: float
) -> None:
    try:
        path = EgoPath.through(points)
    except ScenarioError:  # all within a nanometre
        return
    x, y, _ = path.pose(where * path.length)
    _, laterals = path.project([(x, y)])
    assert abs(laterals[0]) < 1e-6


def test_repeated_points_are_dropped_and_a_single_point_refused() -> None:
    assert len(EgoPath.through([(0, 0), (0, 0), (1, 0)]).vertices) == 2
    with pytest.raises(ScenarioError, match="at least two"):
        EgoPath.through([(3, 3), (3, 3)])
    with pytest.raises(ScenarioError, match="finite"):
        EgoPath.through([(0, 0), (np.nan, 1)])


def test_closest_in_front_is_before_the_bumper_in_the_corridor() -> None:
    people = np.array([[9.0, 1.3], [12.0, -1.2], [15.0, 0.0], [4.9, 0.0], [5.0, 0.0]])
    closest, reachable = corridor([(0, 0), (100, 0)]).closest_now(people, 5.0)
    assert closest == 12.0
    assert reachable


def test_nobody_in_front_is_infinitely_far() -> None:
    plaza = corridor([(0, 0), (100, 0)])
    assert plaza.closest_now(np.empty((0, 2)), 5.0) == (math.inf, False)
    assert plaza.closest_now(np.array([[9.0, 30.0]]), 5.0) == (math.inf, False)
    assert np.isinf(plaza.empty).all()


def test_the_gate_opens_for_whoever_can_walk_into_the_corridor() -> None:
    plaza = corridor([(0, 0), (100, 0)])
    reach = 2.5 * 3 * 0.05
    assert plaza.closest_now(np.array([[9.0, 1.25 + 0.999 * reach]]), 5.0)[1]
    assert not plaza.closest_now(np.array([[9.0, 1.25 + 1.001 * reach]]), 5.0)[1]
    assert not plaza.closest_now(np.array([[5.0 - 1.001 * reach, 0.0]]), 5.0)[1]
    assert plaza.closest_now(np.array([[5.0 - 0.999 * reach, 0.0]]), 5.0)[1]


def test_predicted_people_count_in_front_of_the_moved_bumper() -> None:
    plaza = corridor([(0, 0), (100, 0)])
    walking_in = np.array([[[8.0, 2.0]], [[8.0, 1.0]], [[5.3, 0.0]]])
    ahead = plaza.closest_predicted(walking_in, 5.0, 2.0)  # the bumper: 5.1, 5.2, 5.3 m
    assert ahead.tolist() == [math.inf, 8.0, math.inf]


def test_predicted_poses_follow_the_bend() -> None:
    bend = corridor(L_SHAPE)
    poses = np.zeros((3, 1, 7))
    bend.fill_poses(poses, 0, 9.0, 20.0)  # one metre a step
    assert poses[0, 0, :4] == pytest.approx([6.5, 0, 0, 20])
    front, rear = np.array([10.0, 1.0]), np.array([6.0, 0.0])  # 11 m and 6 m along the path
    heading = math.atan2(1.0, 4.0)
    centre = front - 2.5 * np.array([math.cos(heading), math.sin(heading)])
    assert poses[2, 0, :4] == pytest.approx([*centre, heading, 20])
    assert np.hypot(*(front - rear)) < 5.0  # the body cuts the corner, as SUMO's do


def test_a_body_turns_with_its_rear_on_the_path() -> None:
    path = EgoPath.through(L_SHAPE)
    assert path.pose(9.0, 5.0).heading == 0.0
    assert path.pose(12.5, 5.0).heading == pytest.approx(math.pi / 4)
    assert path.pose(15.1, 5.0).heading == pytest.approx(math.pi / 2)
    assert path.pose(12.5)[:2] == path.pose(12.5, 5.0)[:2] == (10.0, 2.5)


def test_what_is_out_of_sight_is_not_in_front() -> None:
    plaza = corridor([(0, 0), (300, 0)])
    assert plaza.closest_now(np.array([[104.0, 0.0]]), 5.0)[0] == 104.0
    assert plaza.closest_now(np.array([[106.0, 0.0]]), 5.0)[0] == 106.0  # its segment is seen
    pieces = corridor([(x, 0) for x in range(0, 301, 10)])
    assert pieces.closest_now(np.array([[104.0, 0.0]]), 5.0)[0] == 104.0
    assert pieces.closest_now(np.array([[121.0, 0.0]]), 5.0)[0] == math.inf


def test_who_is_in_front_on_a_path_that_comes_past_twice() -> None:
    round_the_block = corridor([(0, 0), (100, 0), (100, 50), (50, 50), (50, -50)])
    at_the_crossing = np.array([[50.5, 0.1]])
    assert round_the_block.closest_now(at_the_crossing, 40.0)[0] == pytest.approx(50.5)
    assert round_the_block.closest_now(at_the_crossing, 190.0)[0] == pytest.approx(249.9)
    assert round_the_block.closest_now(at_the_crossing, 251.0)[0] == math.inf


def test_a_vertex_ahead_brings_nobody_behind_to_the_front() -> None:
    straight_in_pieces = corridor([(0, 0), (10, 0), (20, 0)])
    assert straight_in_pieces.closest_now(np.array([[9.5, 0.0]]), 9.8)[0] == math.inf
    assert straight_in_pieces.closest_now(np.array([[9.9, 0.0]]), 9.8)[0] == pytest.approx(9.9)


@given(
    st.lists(
        st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=3, max_size=7, unique=True
    ),
    st.floats(0, 1),
)
def test_whoever_stands_on_the_path_ahead_is_in_front(
    points: list[tuple[float, float]], where: float
) -> None:
    try:
        path = corridor(points)
    except ScenarioError:
        return
    station = where * path.path.length
    x, y, _ = path.path.pose(station)
    closest, reachable = path.closest_now(np.array([[x, y]]), station - 50.0)
    assert closest <= station + 1e-6
    assert reachable


@st.composite
def roads(draw: st.DrawFn) -> EgoPath:
    """A road of 5 to 40 pieces of 0.5 to 10 m, each turned by 0.4 rad at most."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    pieces = draw(st.integers(5, 40))
    heading = np.cumsum(rng.uniform(-0.4, 0.4, pieces))
    length = rng.uniform(0.5, 10.0, pieces)
    moves = length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
    return EgoPath.through(np.concatenate([np.zeros((1, 2)), np.cumsum(moves, axis=0)]))


@given(roads(), st.floats(-0.1, 1.1), st.floats(0.1, 15.0))
def test_front_and_rear_of_a_body_are_on_the_road(
    path: EgoPath, where: float, length: float
) -> None:
    station = where * path.length
    x, y, heading = path.pose(station, length)
    assert (x, y) == path.pose(station)[:2]
    x_r, y_r, _ = path.pose(station - length)
    chord = math.hypot(x - x_r, y - y_r)
    assert chord <= length + 1e-9
    assert chord * math.cos(heading) == pytest.approx(x - x_r, abs=1e-6)
    assert chord * math.sin(heading) == pytest.approx(y - y_r, abs=1e-6)


@given(roads(), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_nothing_jumps_along_a_road(path: EgoPath, where: float, step: float) -> None:
    """Not the front, and a body's heading no faster than a point turns about the other end."""
    station, length = where * path.length, 5.0
    before, after = path.pose(station, length), path.pose(station + step, length)
    assert math.hypot(after.x - before.x, after.y - before.y) <= step + 1e-9
    turned = abs((after.heading - before.heading + math.pi) % (2 * math.pi) - math.pi)
    rear = path.pose(station - length)
    chord = math.hypot(before.x - rear.x, before.y - rear.y)
    if chord > 3.0:
        assert turned <= 2.0 * math.asin(min(1.0, 2.0 * step / chord)) + 1e-6


@given(roads(), st.floats(0.0, 1.0), st.floats(-10.0, 10.0))
def test_a_place_is_found_again_from_a_rough_station(
    path: EgoPath, where: float, wrong: float
) -> None:
    station = where * path.length
    x, y, _ = path.pose(station)
    found, lateral = path.locate(x, y, near=station + wrong)
    assert abs(lateral) < 1e-6
    assert path.pose(found)[:2] == pytest.approx((x, y), abs=1e-6)


def test_angles_convert_between_the_conventions() -> None:
    from giveway.geometry.path import angle_to_heading, heading_to_angle

    assert heading_to_angle(0.0) == 90.0
    assert heading_to_angle(math.pi / 2) == pytest.approx(0.0)
    assert heading_to_angle(math.pi) == pytest.approx(270.0)
    for angle in (0.0, 45.0, 133.0, 359.0):
        assert heading_to_angle(angle_to_heading(angle)) == pytest.approx(angle)


def test_headings_are_those_of_the_c_library():
    vectors = np.random.default_rng(1).uniform(-9.0, 9.0, (1000, 2))
    assert directions(vectors).tolist() == [math.atan2(y, x) for x, y in vectors.tolist()]
