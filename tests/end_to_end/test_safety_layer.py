"""The safety layer in runs through the real SUMO, FMU and controllers, and on bent ways."""

from collections.abc import Callable

import numpy as np
import pytest
from support.front_poses import front_poses

from controller import Decision, SafetyParameters
from giveway.api import RunResult
from giveway.config import EgoRunConfig
from giveway.ego.safety_layer import Guard
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.path import EgoPath
from pedestrian_model import Crowd

Run = Callable[..., RunResult]

# Fast, and looking at the last metres only: such an ego drives into people on the street.
RECKLESS = {
    "scenario": "street",
    "crowd": {"pedestrians": 60},
    "regulation": {"safe_distance": 0.5, "reference_speed": 8.0},
    "controller_options": {"buffer_distance": 1.0},
    "time_limit": 40.0,
}
ON = {"enabled": True}


@pytest.mark.parametrize(
    ("controller", "seed"), [("pid-paper", 3), ("pid-paper", 9), ("mpc-paper", 9)]
)
def test_a_controller_that_drives_into_people_does_not_with_it(
    run_once: Run, controller: str, seed: int
) -> None:
    without = run_once(**RECKLESS, controller=controller, seed=seed)
    with_it = run_once(**RECKLESS, controller=controller, seed=seed, safety=ON)
    assert without.summary["frontal_contacts"] > 0
    assert with_it.summary["frontal_contacts"] == 0
    assert with_it.completed


def test_the_table_says_where_it_acted_and_what_the_vehicle_got(run_once: Run) -> None:
    ego = run_once(**RECKLESS, controller="pid-paper", seed=3, safety=ON).ego
    acted = ego["controller"] == "safety"
    assert acted.any()
    assert set(ego.loc[acted, "reason"]) == {"safety layer"}
    assert "safety layer" not in set(ego.loc[~acted, "reason"])
    v, u = ego["speed"].to_numpy(), ego["force"].to_numpy()
    after = np.maximum(0.0, 0.995 * v[:-1] + 0.05 / 1000.0 * u[:-1])
    np.testing.assert_allclose(v[1:], after, atol=1e-9)


def test_the_tuned_pid_goes_on_from_the_force_that_acted(run_once: Run) -> None:
    crowd = {"pedestrians": 30, "two_sided": True}
    ego = run_once(controller="pid-tuned", seed=2, crowd=crowd).ego
    acted = (ego["controller"] == "safety").to_numpy()
    force, moves = ego["force"].to_numpy(), ego["speed"].to_numpy() > 0.0
    resumes = np.flatnonzero(acted[:-1] & ~acted[1:] & moves[1:])
    assert len(resumes)
    assert np.abs(force[resumes + 1] - force[resumes]).max() <= 1000.0 + 1e-6


@pytest.mark.parametrize("controller", ["pid-paper", "mpc-paper"])
def test_where_it_does_not_act_not_a_bit_is_changed(run_once: Run, controller: str) -> None:
    same = {"controller": controller, "seed": 5, "crowd": {"pedestrians": 30}}
    without, with_it = run_once(**same), run_once(**same, safety=ON)
    assert with_it.summary["safety_share"] == 0.0
    assert without.ego.equals(with_it.ego)
    assert without.trajectories.equals(with_it.trajectories)


@pytest.mark.parametrize(
    ("controller", "enabled", "on"),
    [
        ("mpc", None, True),
        ("pid-tuned", None, True),
        ("mpc-paper", None, False),
        ("pid-paper", None, False),
        ("pid", None, False),
        ("mpc", False, False),
        ("pid-paper", True, True),
    ],
)
def test_it_is_on_but_not_for_the_papers_controllers(
    controller: str, enabled: bool | None, on: bool
) -> None:
    config = EgoRunConfig.model_validate({"controller": controller, "safety": {"enabled": enabled}})
    assert config.safety_layer is on


# --- bends ------------------------------------------------------------------------------------

ASKED = Decision(400.0, "pid", "selected", "", 0, 4.0, None)


def quarter_turn(radius: float) -> EgoPath:
    """East for 20 m, round to the north, and on for 20 m."""
    angles = np.linspace(0.0, np.pi / 2, 40)
    x = 20.0 + radius * np.sin(angles)
    y = radius * (1.0 - np.cos(angles))
    end = (20.0 + radius, radius + 20.0)
    return EgoPath.through([(0.0, 0.0), *zip(x, y, strict=True), end])


def guard(path: EgoPath) -> Guard:
    config = EgoRunConfig.model_validate({"controller": "mpc"})
    return Guard(SafetyParameters(), config, path, VehicleShape(5.0, 2.0), 0.05)


def person_at(x: float, y: float) -> Crowd:
    return Crowd.create([(x, y)], [(0.0, 0.0)], 1.4, [[(x, y)]])


def test_on_a_straight_way_one_pose_says_everything() -> None:
    way, _ = front_poses(EgoPath.through([(0.0, 0.0), (50.0, 50.0)]), 14.0, 30.0, 5.0)
    half = np.sqrt(0.5)
    np.testing.assert_allclose(way, [[14.0 * half, 14.0 * half, half, half]])


def test_in_a_bend_the_poses_are_those_of_the_body() -> None:
    path = quarter_turn(8.0)
    way, spacing = front_poses(path, 18.0, 6.0, 5.0)
    assert len(way) * spacing > 6.0
    for i, (x, y, cos, sin) in enumerate(way):
        pose = path.pose(18.0 + i * spacing, 5.0)
        assert (x, y) == pytest.approx((pose.x, pose.y))
        assert (cos, sin) == pytest.approx((np.cos(pose.heading), np.sin(pose.heading)))


def test_a_way_of_any_length_is_sampled_to_its_end() -> None:
    way, spacing = front_poses(quarter_turn(8.0), 0.0, 5000.0, 5.0)
    assert (len(way) - 1) * spacing >= 5000.0


def test_in_a_bend_it_brakes_for_people_on_the_path_not_ahead() -> None:
    path = quarter_turn(5.0)
    front = 20.0 + 0.25 * np.pi * 5.0  # half way round
    on_it, heading = path.pose(front + 1.8), path.pose(front, 5.0).heading
    here = path.pose(front)
    assert guard(path).overrule(ASKED, front, 4.0, person_at(on_it.x, on_it.y)).acting == "safety"
    tangent = here.x + 4.0 * np.cos(heading), here.y + 4.0 * np.sin(heading)
    assert guard(path).overrule(ASKED, front, 4.0, person_at(*tangent)) is None


def test_who_is_in_sight_of_nobody_keeps_the_very_decision() -> None:
    path = EgoPath.through([(0.0, 0.0), (100.0, 0.0)])
    assert guard(path).overrule(ASKED, 10.0, 4.0, person_at(40.0, 0.0)) is None
