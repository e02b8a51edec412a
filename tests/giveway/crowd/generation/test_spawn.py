"""The crowd that a seed draws."""

import numpy as np
import pytest

from giveway.config.tables.crowd import CrowdConfig
from giveway.crowd.generation.spawn import spawn
from giveway.errors import CrowdError
from giveway.geometry.path import EgoPath

AXIS = EgoPath.through([(-20, 0), (100, 0)])


def test_equal_seeds_draw_equal_crowds_and_others_other_crowds() -> None:
    first, again, other = (spawn(CrowdConfig(pedestrians=30), AXIS, seed) for seed in (1, 1, 2))
    assert np.array_equal(first.position, again.position)
    assert np.array_equal(first.desired_speed, again.desired_speed)
    assert not np.array_equal(first.position, other.position)


def test_everybody_starts_in_the_area_with_space_around() -> None:
    config = CrowdConfig(pedestrians=100, minimum_spacing=0.5)
    crowd = spawn(config, AXIS, 3)
    x_min, y_min, x_max, y_max = config.spawn_area
    assert (crowd.position >= (x_min, y_min)).all()
    assert (crowd.position <= (x_max, y_max)).all()
    offsets = crowd.position[:, None] - crowd.position[None]
    distance = np.hypot(offsets[..., 0], offsets[..., 1])[np.triu_indices(100, 1)]
    assert distance.min() >= 0.5
    assert crowd.destination == pytest.approx(crowd.position + np.array([0, 30]))


def test_desired_speeds_are_truncated_normal() -> None:
    config = CrowdConfig(pedestrians=2000, spawn_area=(0, 0, 200, 200), minimum_spacing=0)
    speeds = spawn(config, AXIS, 4).desired_speed
    assert speeds.min() >= 0.5
    assert speeds.max() <= 2.2
    assert speeds.mean() == pytest.approx(1.394, abs=0.02)
    assert speeds.std() == pytest.approx(0.26, abs=0.02)


def test_two_sided_mirrors_every_second_one_about_the_egos_axis() -> None:
    one = spawn(CrowdConfig(minimum_spacing=0), AXIS, 5)
    two = spawn(CrowdConfig(minimum_spacing=0, two_sided=True), AXIS, 5)
    assert np.array_equal(two.position[::2], one.position[::2])
    assert two.position[1::2] == pytest.approx(one.position[1::2] * (1, -1))
    assert two.destination[1::2] == pytest.approx(one.destination[1::2] * (1, -1))


def test_nobody_at_all_is_a_crowd_too() -> None:
    crowd = spawn(CrowdConfig(pedestrians=0), AXIS, 1)
    assert crowd.position.shape == (0, 2)
    assert crowd.ids == ()


def test_too_many_for_the_area_is_refused_with_the_numbers() -> None:
    config = CrowdConfig(pedestrians=200, spawn_area=(0, 0, 5, 5), minimum_spacing=1.0)
    with pytest.raises(CrowdError, match=r"--pedestrians 200: only \d+ fit .* 25 m2 .* 1.0 m"):
        spawn(config, AXIS, 1)


def test_two_sided_keeps_the_spacing_across_the_axis() -> None:
    config = CrowdConfig(spawn_area=(8, -6, 16, 6), pedestrians=60, two_sided=True)
    for seed in range(10):
        position = spawn(config, AXIS, seed).position
        offsets = position[:, None] - position[None]
        distance = np.hypot(offsets[..., 0], offsets[..., 1])[np.triu_indices(60, 1)]
        assert distance.min() >= 0.5


def test_two_sided_mirrors_about_the_path_beside_the_area() -> None:
    bend = EgoPath.through([(0, 0), (50, 0), (50, 100)])
    config = CrowdConfig(spawn_area=(55, 60, 60, 70), walk=(-20, 0), two_sided=True)
    crowd = spawn(config, bend, 1)
    assert (crowd.position[1::2, 0] < 50).all()
    assert (crowd.position[:, 1] >= 60).all()
    assert crowd.destination[1::2, 0] == pytest.approx(crowd.position[1::2, 0] + 20)


def test_draws_place_people_and_set_their_speeds_by_their_quantiles() -> None:
    draws = (0.0, 0.0, 0.0, 1.0, -1.0, 2.0)
    config = CrowdConfig(pedestrians=2, spawn_area=(0, 0, 10, 20), draws=draws)
    crowd = spawn(config, AXIS, 1)
    assert crowd.position == pytest.approx(np.array([[5.0, 10.0], [8.413, 3.173]]), abs=1e-3)
    assert crowd.desired_speed[0] == pytest.approx(1.394, abs=1e-3)
    assert crowd.desired_speed[1] == pytest.approx(1.394 + 2 * 0.26, abs=0.02)
    assert np.array_equal(crowd.position, spawn(config, AXIS, 2).position)


def test_draws_have_the_distributions_of_the_seeds() -> None:
    people = 2000
    draws = tuple(np.random.default_rng(1).standard_normal(3 * people))
    drawn = CrowdConfig(pedestrians=people, spawn_area=(0, 0, 60, 60), draws=draws)
    crowd = spawn(drawn, AXIS, 4)
    usual = spawn(drawn.model_copy(update={"draws": ()}), AXIS, 4)
    shares = [0.1, 0.5, 0.9]
    assert np.quantile(crowd.desired_speed, shares) == pytest.approx(
        np.quantile(usual.desired_speed, shares), abs=0.05
    )
    assert np.quantile(crowd.position, shares) == pytest.approx(
        np.quantile(usual.position, shares), abs=2.5
    )


def test_draws_that_do_not_fit_the_crowd_are_refused() -> None:
    with pytest.raises(ValueError, match=r"2 numbers for pedestrians = 1: expected 3 for each"):
        CrowdConfig(pedestrians=1, draws=(0.0, 1.0))
    with pytest.raises(ValueError, match="needs a varying number of draws"):
        CrowdConfig(pedestrians=1, sampler="encounters", draws=(0.0, 0.0, 0.0))
