"""Walls: the nearest wall point, its force, and what one should see of people between walls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from crowd_forces import forces_apart
from hypothesis import given, settings
from hypothesis import strategies as st

from pedestrian_model import (
    SIM,
    Crowd,
    CrowdModel,
    ParameterError,
    Surroundings,
    SurroundingsError,
    Vehicles,
    Walls,
    arrived,
)

NOBODY = Vehicles.empty()
V0 = SIM.desired_speed


def ring(corners):
    """(k, 4) the closed wall round a polygon: walkable inside if counter-clockwise."""
    corners = np.asarray(corners, float)
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)


def signed_distance(points, corners):
    """(n,) distance to a polygon's border, negative outside: brute force and even-odd rule."""
    a, b = np.asarray(corners, float), np.roll(corners, -1, axis=0)
    d = points[:, None] - a
    share = np.clip((d * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0.0, 1.0)
    distance = np.linalg.norm(d - share[..., None] * (b - a), axis=-1).min(axis=1)
    straddles = (a[:, 1] > points[:, 1:]) != (b[:, 1] > points[:, 1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = a[:, 0] + (points[:, 1:] - a[:, 1]) * (b - a)[:, 0] / (b - a)[:, 1]
    inside = (straddles & (points[:, :1] < x)).sum(axis=1) % 2 == 1
    return np.where(inside, distance, -distance)


def standing(points):
    points = np.atleast_2d(np.asarray(points, float))
    return Crowd.create(points, np.zeros_like(points), 1.0, list(points[:, None]))


def force_at(points, walls, parameters=SIM):
    alone = replace(parameters, interaction_radius=1e-3)
    return forces_apart(CrowdModel(alone), standing(points), NOBODY, Surroundings(walls)).wall


FLOOR = Walls.create([(-50.0, 0.0, 50.0, 0.0)])  # walkable above


@pytest.mark.parametrize(
    ("height", "force"),
    [
        (1.0, 2500.0 * np.exp(-16.0 * 0.73)),
        (0.5, 2500.0 * np.exp(-16.0 * 0.23)),  # 63 N: a twelfth of what drives a walker
        (0.27, 2500.0),
        (0.2, 2500.0 * np.exp(16.0 * 0.07) + 9825.125 * 0.07),
        (-0.1, 9825.125 * 0.37),
        (-0.999, 9825.125 * 1.269),
        (-1.001, 0.0),
        (2.001, 0.0),
        (30.0, 0.0),
    ],
)
def test_golden_values_of_the_force(height, force):
    f = force_at([(3.0, height)], FLOOR)[0]
    assert f[0] == 0.0
    assert f[1] == pytest.approx(force, rel=1e-9, abs=1e-12)


def test_on_the_line_the_force_is_the_walls_normal_and_capped():
    f = force_at([(3.0, 0.0), (-50.0, 0.0)], FLOOR)
    np.testing.assert_allclose(f[:, 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(f[:, 1], 2500.0 * np.exp(4.0) + 9825.125 * 0.27, rtol=1e-12)


@pytest.mark.parametrize("corners", [3, 4, 7, 20])
@pytest.mark.parametrize("orientation", [1, -1])
@settings(max_examples=25)
@given(seed=st.integers(0, 10**6))
def test_the_nearest_wall_point_of_any_polygon(corners, orientation, seed):
    """A star-shaped polygon, sharp corners of both kinds, walkable inside or outside."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0.0, 0.4, corners) + np.arange(corners))
    angle *= 2.0 * np.pi / corners  # gaps of less than half a turn: a simple polygon
    polygon = rng.uniform(1.0, 9.0, corners)[:, None] * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    points = rng.uniform(-10.0, 10.0, (400, 2))
    expected = orientation * signed_distance(points, polygon)
    distance, normal = Walls.create(ring(polygon[::orientation])).nearest(points)
    near = np.abs(expected) <= 2.0
    np.testing.assert_allclose(distance[near], expected[near], rtol=0.0, atol=1e-9)
    assert (np.abs(distance[~near]) >= 2.0).all()
    # the normal leads to the wall point and into the walkable side
    foot = points[near] - distance[near, None] * normal[near]
    np.testing.assert_allclose(signed_distance(foot, polygon), 0.0, atol=1e-8)
    np.testing.assert_allclose(np.linalg.norm(normal[near], axis=1), 1.0, rtol=1e-12)


def test_a_thin_wall_keeps_people_off_on_both_sides():
    thin = Walls.create([(0.0, 0.0, 9.0, 0.0), (9.0, 0.0, 0.0, 0.0)])
    distance, normal = thin.nearest([(4.0, 0.3), (4.0, -0.3), (9.4, 0.0), (-0.3, 0.4)])
    np.testing.assert_allclose(distance, [0.3, 0.3, 0.4, 0.5])
    np.testing.assert_allclose(normal, [(0, 1), (0, -1), (1, 0), (-0.6, 0.8)], atol=1e-12)


def test_a_loose_end_is_a_post():
    distance, normal = FLOOR.nearest([(50.3, 0.4), (50.3, -0.4)])
    np.testing.assert_allclose(distance, [0.5, 0.5])
    np.testing.assert_allclose(normal, [(0.6, 0.8), (0.6, -0.8)])


def test_where_two_blocks_touch_each_corner_is_its_own():
    """Two houses meet at a point: the corner between their walls is not the houses' inside."""
    one, other = [(0, 0), (0, -4), (-4, -4), (-4, 0)], [(0, 0), (0, 4), (4, 4), (4, 0)]
    walls = Walls.create(np.concatenate([ring(one), ring(other)]))  # clockwise: walkable outside
    walls_reversed = Walls.create(np.concatenate([ring(other), ring(one)]))
    points = np.array([(-0.5, 0.4), (0.5, -0.4), (-0.3, -0.4), (0.3, 0.4), (-0.01, 0.02)])
    for each in (walls, walls_reversed):
        np.testing.assert_allclose(
            each.nearest(points)[0], [0.4, 0.4, -0.3, -0.3, 0.01], atol=1e-12
        )


@pytest.mark.parametrize("swap", [False, True])
def test_where_sharp_blocks_touch_each_place_has_its_side(swap):
    west, east = [(0, 0), (-4, -1), (-4, 1)], [(0, 0), (4, 3), (3, 0)]
    houses = [east, west] if swap else [west, east]
    walls = Walls.create(np.concatenate([ring(house) for house in houses]))  # clockwise
    points = np.random.default_rng(2).uniform(-1.0, 1.0, (500, 2))
    outside = [-signed_distance(points, house) for house in houses]
    expected = np.where(
        np.minimum(*outside) > 0.0, np.minimum(*outside), -np.abs(outside).min(axis=0)
    )
    np.testing.assert_allclose(walls.nearest(points)[0], expected, atol=1e-9)


def test_small_gaps_at_a_corner_are_closed():
    exact, loose = [(-9, 0, 0, 0), (0, 0, 0, -9)], [(-9, 0, -0.004, 0), (0, -0.004, 0, -9)]
    points = np.array([(0.3, 0.3), (-0.2, -0.5), (0.0, 0.5), (-0.4, -0.1)])
    a, b = Walls.create(exact).nearest(points)[0], Walls.create(loose).nearest(points)[0]
    np.testing.assert_allclose(a, b, atol=0.006)


def test_a_city_far_from_the_origin_or_very_wide_is_found_too():
    for corner, size in ((1e6, 30.0), (-3e5, 4e4)):
        square = corner + size * np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
        inside = corner + np.array([(0.4, size / 2), (size / 2, size - 0.7), (-0.5, size / 3)])
        distance, _ = Walls.create(ring(square)).nearest(inside)
        np.testing.assert_allclose(distance, [0.4, 0.7, -0.5], atol=1e-6)


def test_a_wall_stops_a_walker_before_the_body_overlaps_much():
    start = np.stack([np.arange(20) * 9.0 - 90.0, np.linspace(3.0, 3.0 + V0 * 0.05, 20)], axis=1)
    wall = Surroundings(Walls.create([(-99.0, 0.0, 99.0, 0.0)]))
    crowd = Crowd.create(
        start, np.tile([0.0, -V0], (20, 1)), V0, list((start - (0.0, 20.0))[:, None])
    )
    model, closest = CrowdModel(), np.inf
    for _ in range(300):
        model.advance(crowd, NOBODY, wall)
        closest = min(closest, crowd.position[:, 1].min())
    assert SIM.body_radius - closest < 0.07
    assert (crowd.position[:, 1] > SIM.body_radius).all()  # and stands clear of it
    assert (np.abs(crowd.velocity) < 1e-3).all()


def test_walking_along_a_wall_half_a_metre_off_is_free():
    crowd = Crowd.create([(-40.0, 0.5)], [(V0, 0.0)], V0, [[(40.0, 0.5)]])
    model = CrowdModel()
    for _ in range(600):
        model.advance(crowd, NOBODY, Surroundings(FLOOR))
        assert crowd.velocity[0, 0] == pytest.approx(V0, rel=2e-3)
        assert 0.5 <= crowd.position[0, 1] < 0.75


def bend(width=3.0):
    """A corridor that turns left by a right angle, as a polygon, counter-clockwise."""
    w = width
    return np.array([(-20, 0), (w, 0), (w, 20), (0, 20), (0, w), (-20, w)], float)


def pushing_crowd():
    """80 people shoulder to shoulder, on their way through the bend to its end."""
    rng = np.random.default_rng(1)
    x, y = np.meshgrid(np.arange(-19.0, -5.0, 0.7), np.arange(0.5, 2.6, 0.65))
    start = np.stack([x.ravel(), y.ravel()], axis=1)
    start += rng.uniform(-0.05, 0.05, start.shape)
    n, turn = len(start), 0.5**0.5
    return Crowd.create(
        start,
        np.zeros((n, 2)),
        rng.uniform(1.2, 1.6, n),
        [[(1.5, 1.5), (1.5, 12.0), (1.5, 19.0)]] * n,
        passages=[[(turn, turn, 2.0), (0.0, 1.0, 1.5), (0.0, 1.0, 1.5)]] * n,
    )


def test_no_crowd_pushes_anybody_out_of_a_corridors_bend():
    crowd, walls, model = pushing_crowd(), Surroundings(Walls.create(ring(bend()))), CrowdModel()
    for _ in range(1200):
        model.advance(crowd, NOBODY, walls)
        assert (signed_distance(crowd.position, bend()) > 0.0).all()
        assert (np.hypot(*crowd.velocity.T) <= SIM.max_speed + 1e-12).all()
        crowd = crowd.select(~arrived(crowd, 1.0))
    assert len(crowd) == 0


def test_who_is_squeezed_beyond_a_dead_end_comes_back():
    """80 people press on for 50 s and nobody arrives; then most are taken away."""
    crowd, walls, model = pushing_crowd(), Surroundings(Walls.create(ring(bend()))), CrowdModel()
    deepest = 0.0
    for _ in range(1000):
        model.advance(crowd, NOBODY, walls)
        deepest = min(deepest, signed_distance(crowd.position, bend()).min())
    assert -1.0 < deepest < 0.0
    crowd = crowd.select(np.arange(80) % 4 == 1)
    for _ in range(100):
        model.advance(crowd, NOBODY, walls)
    assert (signed_distance(crowd.position, bend()) > 0.1).all()


@pytest.mark.parametrize("aside", [0.02, 0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("side", [-1, 1])
def test_nobody_is_stuck_at_a_convex_corner(aside, side):
    """The straight way leads through the corner of a house at the origin, walkable outside."""
    house = [(0.0, 0.0), (-9.0, 9.0), (-18.0, 0.0), (-9.0, -9.0)]  # its corner points along +x
    walls = Surroundings(Walls.create(ring(house)[:, [2, 3, 0, 1]]))
    start, goal = np.array([-1.0 + aside, -7.0]), np.array([-1.0 + aside, 7.0])
    start, goal = start * (1, side), goal * (1, side)
    crowd = Crowd.create([start], [(0.0, side * V0)], V0, [[goal]])
    model = CrowdModel()
    for _ in range(400):
        model.advance(crowd, NOBODY, walls)
    np.testing.assert_allclose(crowd.position[0], goal, atol=0.1)


def test_the_mirror_image_of_a_scene_is_its_mirror_image():
    """Without navigation, which keeps right."""
    model = CrowdModel(replace(SIM, navigation_strength=0.0))
    rng = np.random.default_rng(3)
    start = np.stack([rng.uniform(-18, -2, 30), rng.uniform(0.4, 2.6, 30)], axis=1)
    mirror = np.array([1.0, -1.0])
    corridor = ring(bend())
    flipped = ring((bend() * mirror)[::-1])
    one, other = (
        Crowd.create(start * m, np.zeros((30, 2)), 1.4, [[(1.5, 1.5) * m, (1.5, 18.0) * m]] * 30)
        for m in (np.ones(2), mirror)
    )
    for _ in range(60):
        one = model.step(one, NOBODY, Surroundings(Walls.create(corridor)))
        other = model.step(other, NOBODY, Surroundings(Walls.create(flipped)))
    np.testing.assert_allclose(other.position, one.position * mirror, rtol=0.0, atol=1e-6)


@settings(max_examples=40)
@given(seed=st.integers(0, 10**6))
def test_among_any_walls_limits_are_kept_and_nothing_is_nan(random_crowd, random_vehicles, seed):
    """Walls anywhere, through people and each other, some without length."""
    rng = np.random.default_rng(seed)
    segments = rng.uniform(-1.0, 9.0, (12, 4))
    segments[3, 2:] = segments[3, :2]
    segments[5, :2] = segments[4, 2:]
    crowd, vehicles = random_crowd(30, seed), random_vehicles(seed)
    crowd.position[0] = segments[0, :2]
    crowd.position[1] = segments[1, :2] * 0.5 + segments[1, 2:] * 0.5
    model = CrowdModel()
    for _ in range(20):
        after = model.step(crowd, vehicles, Surroundings(Walls.create(segments)))
        assert np.isfinite(after.position).all()
        assert (np.hypot(*after.velocity.T) <= SIM.max_speed + 1e-12).all()
        crowd = after


def test_the_wall_is_part_of_the_total_but_not_of_beta(random_crowd, random_vehicles):
    crowd, vehicles = random_crowd(30, 1), random_vehicles(1)
    walls = Surroundings(Walls.create([(-9.0, 4.0, 19.0, 4.0)]))
    open_, walled = (
        forces_apart(CrowdModel(), crowd, vehicles, *surroundings)
        for surroundings in ((), (walls,))
    )
    assert np.any(walled.wall)
    assert not np.any(open_.wall)
    np.testing.assert_array_equal(walled.beta, open_.beta)
    np.testing.assert_allclose(walled.total, open_.total + walled.wall, rtol=1e-12, atol=1e-9)


def test_no_walls_are_no_walls():
    for none in (Walls.create([]), Walls.create([(1.0, 1.0, 1.0, 1.0)])):
        assert len(none) == 0
        np.testing.assert_array_equal(none.nearest([(0.0, 0.0)])[0], np.inf)
        np.testing.assert_array_equal(force_at([(1.0, 1.0)], none), 0.0)


@pytest.mark.parametrize(
    ("segments", "message"),
    [
        ([(0.0, 0.0, 1.0)], r"segments has shape \(1, 3\), expected \(any, 4\)"),
        ([(0.0, 0.0, 1.0, np.nan)], r"segments\[0, 3\] = nan"),
        ([("a", 0.0, 1.0, 1.0)], "segments: expected numbers"),
    ],
)
def test_bad_walls_are_refused_by_index_and_value(segments, message):
    with pytest.raises(SurroundingsError, match=message):
        Walls.create(segments)


@pytest.mark.parametrize("change", [{"wall_decay": 0.0}, {"wall_strength": -1.0}])
def test_the_walls_parameters_are_checked(change):
    with pytest.raises(ParameterError, match=next(iter(change))):
        replace(SIM, **change)
