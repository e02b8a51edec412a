"""The safety layer in runs through the real SUMO, FMU and controllers, and on bent ways."""

from collections.abc import Callable

import numpy as np
import pytest

from giveway.api import RunResult
from giveway.config import EgoRunConfig

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
    crowd = {"pedestrians": 30, "two_sided": True, "preset": "SIM"}
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
