"""The vehicle influence f_v: golden values, the figure of the paper, several cars, odd places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pedestrian_model import SIM, CrowdError, Vehicles, vehicle_influence


def car(u):
    """The paper's car: 5 m x 2 m, centre at (15, 15), facing +x."""
    return Vehicles.create(15.0, 15.0, 0.0, u, front=2.5, rear=2.5, width=2.0)


@pytest.mark.parametrize(
    ("x", "v", "u", "force", "distance"),
    [
        ((17, 17), (0, -1.3), 4.0, (0, 194.8375), 0.7849),
        ((15, 16.5), (0, -1.3), 0.0, (0, 747.8864), 0.2849),
        ((12, 15), (1.3, 0), 2.0, (-233.2757, 0), 0.2849),
        ((22, 17), (0, -1.3), 4.0, (5.5309, 25.3872), 1.5703),
        ((20, 15.4), (0, 0), 4.0, (1001.738, 4598.0748), -0.4188),
    ],
)
def test_golden_values(x, v, u, force, distance):
    f, s = vehicle_influence([x], [v], car(u))
    np.testing.assert_allclose(f[0], force, rtol=1e-5, atol=1e-9)
    assert s[0] == pytest.approx(distance, abs=5e-5)


@pytest.mark.parametrize(
    ("u", "sizes"),
    [
        (0.0, (748, 55, 4, 0, 0, 0, 0)),
        (1.0, (13258, 2078, 372, 37, 0, 0, 0)),
        (2.0, (13258, 4949, 1742, 613, 8, 0, 0)),
        (4.0, (13258, 8209, 4706, 2698, 887, 58, 0)),
    ],
)
def test_influence_in_front_grows_with_speed_as_in_figure_2(u, sizes):
    ahead = np.array([3, 4, 5, 6, 8, 10, 12])
    points = np.stack([15.0 + ahead, np.full(7, 15.4)], axis=1)
    f, _ = vehicle_influence(points, np.zeros((7, 2)), car(u))
    np.testing.assert_array_equal(np.round(np.hypot(*f.T)), sizes)


@pytest.mark.parametrize("u", [0.0, 0.19, 0.2, 4.0, -0.19, -3.0])
@pytest.mark.parametrize("psi", [0.0, 0.7, -2.0, 1.5707963267948966])
def test_agrees_with_the_reference_all_round_the_car(reference, u, psi):
    rng = np.random.default_rng(3)
    points, v = rng.uniform(-12.0, 12.0, (300, 2)), rng.normal(0.0, 1.0, (300, 2))
    lopsided = Vehicles.create(1.0, -2.0, psi, u, front=3.7, rear=1.1, width=1.8)
    f, s = vehicle_influence(points, v, lopsided)
    for k in range(300):
        f_k, s_k = reference.vehicle(SIM, lopsided.array[0], points[k], v[k])
        np.testing.assert_allclose(f[k], f_k, rtol=1e-9, atol=1e-9)
        assert s[k] == pytest.approx(s_k, abs=1e-12)


def test_below_the_static_speed_the_contour_keeps_its_shape():
    points = np.array([[18.2, 15.3], [12.0, 15.0], [15.0, 16.6]])
    _, at_rest = vehicle_influence(points, np.zeros((3, 2)), car(0.0))
    _, creeping = vehicle_influence(points, np.zeros((3, 2)), car(0.1999))
    np.testing.assert_array_equal(at_rest, creeping)


def test_in_reverse_the_nose_points_backwards():
    forward = Vehicles.create(0.0, 0.0, 0.0, 2.0, front=1.0, rear=3.0)
    reverse = Vehicles.create(0.0, 0.0, np.pi, -2.0, front=3.0, rear=1.0)
    points = np.random.default_rng(0).uniform(-6.0, 6.0, (50, 2))
    f, s = vehicle_influence(points, np.zeros((50, 2)), forward)
    g, t = vehicle_influence(points, np.zeros((50, 2)), reverse)
    np.testing.assert_allclose(f, g, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(s, t, rtol=0.0, atol=1e-12)


def test_several_vehicles_add_up_and_the_nearest_contour_counts():
    points, v = np.array([[2.0, 3.0], [9.0, 1.0]]), np.array([[0.0, -1.0], [0.5, 0.0]])
    one = Vehicles.create(0.0, 0.0, 0.3, 3.0)
    other = Vehicles.create(9.0, 4.0, -2.0, -1.0)
    both = Vehicles.create([0.0, 9.0], [0.0, 4.0], [0.3, -2.0], [3.0, -1.0])
    (f, s), (g, t) = (vehicle_influence(points, v, a) for a in (one, other))
    f_both, s_both = vehicle_influence(points, v, both)
    np.testing.assert_allclose(f_both, f + g, rtol=1e-14)
    np.testing.assert_array_equal(s_both, np.minimum(s, t))


def test_who_is_beside_the_body_is_pushed_sideways_only():
    points = np.stack([np.linspace(12.3, 17.7, 40), 15.0 + np.linspace(-1.2, 1.2, 40)], axis=1)
    f, s = vehicle_influence(points, np.zeros((40, 2)), car(4.0))
    assert (s < 0.0).all()
    np.testing.assert_array_equal(f[:, 0], 0.0)
    assert (np.sign(f[:, 1]) == np.sign(points[:, 1] - 15.0)).all()


@pytest.mark.parametrize(
    ("point", "u", "normal"),
    [
        ((0.0, 2.0), 4.0, (0.0, 1.0)),
        ((0.0, -2.0), 4.0, (0.0, -1.0)),
        ((3.0, 0.5), 0.0, (1.0, 0.0)),
        ((3.0, 2.0), 0.0, (1.0, 0.0)),  # a corner of the rectangle: the front face's normal
    ],
)
def test_on_the_contour_the_force_points_along_the_edges_normal(point, u, normal):
    round_numbers = replace(SIM, vehicle_clearance=0.0)
    square = Vehicles.create(0.0, 0.0, 0.0, u, front=3.0, rear=2.0, width=4.0)
    f, s = vehicle_influence([point], [(0.0, 0.0)], square, round_numbers)
    expected = SIM.vehicle_strength * np.exp(SIM.vehicle_decay * SIM.body_radius)
    assert np.hypot(*f[0]) == pytest.approx(expected, rel=1e-12)
    assert s[0] == 0.0
    np.testing.assert_allclose(f[0] / expected, normal, rtol=0.0, atol=1e-12)


def test_the_exponent_is_capped():
    wide = Vehicles.create(0.0, 0.0, 0.0, 0.0, front=20.0, rear=20.0, width=40.0)
    f, s = vehicle_influence([(0.0, 1.0)], [(0.0, 0.0)], wide)
    assert s[0] < -15.0
    assert np.hypot(*f[0]) == pytest.approx(SIM.vehicle_strength * np.exp(4.0), rel=1e-12)


def test_without_vehicles_there_is_no_force_and_no_distance():
    f, s = vehicle_influence([(0.0, 0.0)], [(1.0, 0.0)], Vehicles.empty())
    np.testing.assert_array_equal(f, 0.0)
    assert s[0] == np.inf


@pytest.mark.parametrize(
    ("points", "velocities", "message"),
    [
        ([(0.0, np.nan)], [(0.0, 0.0)], r"points\[0, 1\] = nan"),
        ([(0.0, 0.0, 0.0)], [(0.0, 0.0)], r"points has shape \(1, 3\)"),
        ([(0.0, 0.0)], [(0.0, 0.0), (1.0, 1.0)], r"velocities has shape \(2, 2\)"),
    ],
)
def test_bad_points_are_named(points, velocities, message):
    with pytest.raises(CrowdError, match=message):
        vehicle_influence(points, velocities, car(1.0))
