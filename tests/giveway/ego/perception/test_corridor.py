"""Who is in front: pedestrians and vehicles about the ego's path, against the plain definition."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from giveway.ego.perception.corridor import Corridor, closest_in_front
from giveway.ego.perception.leader import NO_LEADER, Leader
from giveway.geometry.kernel import kernel
from giveway.geometry.passage import SIGHT
from giveway.geometry.path import EgoPath

closest_in_front = kernel(closest_in_front)

STRAIGHT = EgoPath.through([(0.0, 0.0), (300.0, 0.0)])
IN_PIECES = EgoPath.through([(float(x), 0.0) for x in range(301)])
HALF_WIDTH = 1.25  # [m]
WALKING = 2.5  # [m/s] at most
FRONT = 100.0  # [m] the ego's front bumper
Vehicle = tuple[float, float, float, float]  # x, y of the centre [m], heading [rad], speed [m/s]
LENGTH, WIDTH = 5.0, 2.0  # [m]

numbers = st.floats(0.0, 1.0)


def corridor(path: EgoPath, *, horizon: int = 15, half_width: float = HALF_WIDTH) -> Corridor:
    return Corridor(
        path,
        half_width=half_width,
        horizon=horizon,
        time_step=0.05,
        walking_speed_limit=WALKING,
    )


def trajectories(vehicles: list[Vehicle], horizon: int) -> np.ndarray:
    """(N, m, 7) of vehicles that go straight on."""
    poses = np.zeros((horizon, len(vehicles), 7))
    poses[:, :, 4:] = LENGTH / 2, LENGTH / 2, WIDTH
    for j, (x, y, heading, speed) in enumerate(vehicles):
        driven = speed * 0.05 * np.arange(horizon)
        poses[:, j, 0] = x + driven * math.cos(heading)
        poses[:, j, 1] = y + driven * math.sin(heading)
        poses[:, j, 2:4] = heading, speed
    return poses


def closest_vehicle(
    vehicle: Vehicle, *, path: EgoPath = STRAIGHT, horizon: int = 15, half_width: float = HALF_WIDTH
) -> tuple[Leader, np.ndarray]:
    """The closest to an ego of 4 m/s whose front is at ``FRONT``, among it and ``vehicle``."""
    poses = trajectories([(FRONT - LENGTH / 2, 0.0, 0.0, 4.0), vehicle], horizon)
    return corridor(path, horizon=horizon, half_width=half_width).closest_vehicle(
        poses, 0, FRONT, 4.0
    )


# --- vehicles ----------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [STRAIGHT, IN_PIECES], ids=["one segment", "many"])
@pytest.mark.parametrize("gap", [0.1, 2.5, 8.0, 15.0])
@pytest.mark.parametrize("speed", [5.0, 14.0, 30.0])
@pytest.mark.parametrize("aside", [0.0, 1.5])
def test_a_follower_is_never_in_front_however_fast_it_is(
    path: EgoPath, gap: float, speed: float, aside: float
) -> None:
    follower = (FRONT - LENGTH - gap - LENGTH / 2, aside, 0.0, speed)
    leader, ahead = closest_vehicle(follower, path=path, horizon=60)
    assert leader == NO_LEADER
    assert np.isinf(ahead).all()


def test_a_leader_is_expected_to_go_on_as_it_does() -> None:
    leader, ahead = closest_vehicle((FRONT + 12.0 + LENGTH / 2, 0.0, 0.0, 3.0))
    assert leader == pytest.approx(Leader(FRONT + 12.0, 3.0))
    assert ahead == pytest.approx(FRONT + 12.0 + 0.15 * np.arange(1, 16))


@pytest.mark.parametrize(
    ("heading", "speed", "row"),
    [(0.0, 3.0, 1), (0.9, 3.0, 1), (1.2, 3.0, -1), (math.pi, 3.0, -1), (math.pi / 2, 0.0, 1)],
)
def test_one_that_drives_the_same_way_or_stands_is_followed(
    heading: float, speed: float, row: int
) -> None:
    poses = trajectories(
        [(FRONT - LENGTH / 2, 0.0, 0.0, 4.0), (FRONT + 9.0, 0.0, heading, speed)], 3
    )
    seen = corridor(STRAIGHT, horizon=3)
    leader, _ = seen.closest_vehicle(poses, 0, FRONT, 4.0)
    assert leader != NO_LEADER
    assert seen.followed.row == row
    if row > 0:
        assert seen.followed[:2] == pytest.approx(leader)


def test_one_in_the_next_lane_is_not_in_front() -> None:
    assert closest_vehicle((FRONT + 5.0, 3.2, 0.0, 4.0))[0] == NO_LEADER
    assert closest_vehicle((FRONT + 5.0, -3.2, math.pi, 4.0))[0] == NO_LEADER


def test_one_that_comes_against_us_does_not_go_on_ahead() -> None:
    leader, ahead = closest_vehicle((FRONT + 20.0, 0.0, math.pi, 8.0))
    assert leader == pytest.approx(Leader(FRONT + 20.0 - LENGTH / 2, 0.0))
    assert ahead.max() <= FRONT + 20.0


def test_one_from_the_side_is_expected_in_the_corridor() -> None:
    leader, ahead = closest_vehicle((FRONT + 10.0, -8.0, math.pi / 2, 10.0))
    assert leader == NO_LEADER
    nose = -8.0 + LENGTH / 2 + 0.5 * np.arange(15)
    expected = nose >= -HALF_WIDTH
    assert (np.isfinite(ahead[: len(nose) - 1]) == expected[1:]).all()
    assert ahead[np.isfinite(ahead)] == pytest.approx(FRONT + 10.0 - WIDTH / 2)


@pytest.mark.parametrize("half_width", [0.2, 0.5, HALF_WIDTH, 3.0])
@given(x=numbers, y=numbers, turn=numbers)
@settings(max_examples=60)
def test_the_closest_point_of_a_vehicle_is_found(
    half_width: float, x: float, y: float, turn: float
) -> None:
    """Against its whole outline, point by point; the kernel looks at one in each metre at least."""
    vehicle = (FRONT + 40.0 * x - 10.0, 8.0 * y - 4.0, 2.0 * math.pi * turn, 0.0)
    station = closest_vehicle(vehicle, half_width=half_width)[0].station
    t = np.linspace(-1.0, 1.0, 501)
    one = np.ones_like(t)
    along = np.concatenate([t, t, one, -one]) * LENGTH / 2
    across = np.concatenate([one, -one, t, t]) * WIDTH / 2
    cos, sin = math.cos(vehicle[2]), math.sin(vehicle[2])
    outline_x = vehicle[0] + cos * along - sin * across
    outline_y = vehicle[1] + sin * along + cos * across
    inside = (np.abs(outline_y) <= half_width) & (outline_x > FRONT)
    deep = (np.abs(outline_y) <= half_width - 0.02) & (outline_x > FRONT)
    if not inside.any():
        assert station == math.inf or abs(station - FRONT) < 1.0
        return
    closest = outline_x[inside].min()
    assert station >= closest - 0.02
    crossing = (outline_y < -half_width).any() and (outline_y > half_width).any()
    if crossing and deep.any() and closest > FRONT + 2.0:
        assert station <= closest + 1.5


# --- pedestrians -------------------------------------------------------------------------------


@st.composite
def winding_paths(draw: st.DrawFn) -> EgoPath:
    """A path of up to 600 m whose bends may bring it back across itself."""
    steps = draw(st.integers(2, 60))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    heading = np.cumsum(rng.normal(0.0, draw(st.floats(0.0, 0.6)), steps))
    length = rng.uniform(0.5, 12.0, steps)
    moves = length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
    return EgoPath.through(np.concatenate([np.zeros((1, 2)), np.cumsum(moves, axis=0)]))


@given(path=winding_paths(), share=numbers, seed=st.integers(0, 2**32 - 1))
@settings(max_examples=150)
def test_the_corridor_on_a_long_path_is_that_of_the_whole_path(
    path: EgoPath, share: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    front = share * path.length
    people = path.vertices[rng.integers(len(path.vertices), size=40)] + rng.normal(0, 3, (40, 2))
    now, _ = corridor(path).closest_now(people, front)
    everywhere, _ = closest_in_front(
        path.vertices, path.stations, (0, len(path.vertices) - 2), people, front, HALF_WIDTH, 0.0
    )
    if everywhere <= front + SIGHT:
        assert now == everywhere
    else:
        assert now > front + SIGHT


@given(
    path=winding_paths(),
    share=numbers,
    seed=st.integers(0, 2**32 - 1),
    horizon=st.sampled_from([2, 15, 200]),
)
@settings(max_examples=150)
def test_who_can_get_in_front_within_the_horizon_is_predicted(
    path: EgoPath, share: float, seed: int, horizon: int
) -> None:
    """The prediction is skipped only where no walk within the horizon ends in front."""
    rng = np.random.default_rng(seed)
    front = share * path.length
    reach = WALKING * horizon * 0.05
    at = path.pose(front + rng.uniform(0.1, SIGHT - reach))
    aside = rng.uniform(-0.99, 0.99) * HALF_WIDTH
    then = np.array([at.x - aside * math.sin(at.heading), at.y + aside * math.cos(at.heading)])
    angle, walked = rng.uniform(0, 2 * math.pi), reach * rng.uniform()
    person = then - walked * np.array([math.cos(angle), math.sin(angle)])
    one = corridor(path, horizon=horizon)
    if one.closest_predicted(np.tile(then, (horizon, 1, 1)), front, 0.0)[-1] < math.inf:
        _, needed = one.closest_now(person[None], front)
        assert needed


def test_a_long_horizon_looks_as_far_back_as_people_walk_in_it() -> None:
    """15 m behind the front of an ego that waits, and in front of it 6 s later."""
    one = corridor(IN_PIECES, horizon=200)
    _, needed = one.closest_now(np.array([[FRONT - 15.0, 1.3]]), FRONT)
    assert needed
