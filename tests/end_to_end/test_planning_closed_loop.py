"""The planning MPC on the real SUMO, FMU and solver."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import giveway
from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from collections.abc import Callable

    from giveway.api import RunResult

    Run = Callable[..., RunResult]

FREE, GIVES_WAY = 7, 4  # crowds that leave the ego alone, and that it waits for
SHORT = 9.0  # [s] the first pedestrians and the ego meet after some 6 s
SIM = {"crowd": {"preset": "SIM"}, "perception": {"preset": "SIM"}}
SWITCHES = {
    "effort_weight": 0.0,
    "jerk_weight": 0.0,
    "precaution_weight": 0.0,
    "later_weight": 0.0,
    "horizon": 1.0,
}


@pytest.fixture
def drive(run_once: Run) -> Run:
    """Drive before people of SIM, who are known: the seeds were chosen for these crowds."""
    return lambda **config: run_once(**config, **SIM)


def speeds(run: RunResult) -> np.ndarray:
    return run.ego_track.speed


@pytest.mark.parametrize("seed", [FREE, GIVES_WAY])
def test_it_drives_its_way_and_touches_nobody(drive: Run, seed: int) -> None:
    run = drive(controller="mpc", seed=seed)
    assert run.ending is Ending.COMPLETED
    assert run.summary["frontal_contacts"] == 0
    assert run.summary["mpc_feasibility_rate"] == 1.0  # a soft corridor always leaves a plan
    assert (run.summary["longest_wait"] > 0.5) == (seed == GIVES_WAY)


def test_it_keeps_the_actuators_limits_where_it_acts(drive: Run) -> None:
    ego = drive(controller="mpc", seed=GIVES_WAY).ego_track
    planned = (ego.controller[1:] == "mpc") & (ego.speed[1:] > 1e-3) & (ego.speed[:-1] > 1e-3)
    assert np.abs(ego.force).max() <= 8000.0
    assert np.abs(np.diff(ego.force))[planned].max() <= 1000.0 + 1e-6
    assert planned.sum() > 100


def test_the_same_seed_gives_the_same_bytes(drive: Run) -> None:
    config = {"controller": "mpc", "seed": GIVES_WAY, "time_limit": SHORT}
    one, other = drive(**config), giveway.run(config | SIM)
    for name in ("position", "speed", "force"):
        assert getattr(one.ego_track, name).tobytes() == getattr(other.ego_track, name).tobytes()


@pytest.mark.parametrize("name", SWITCHES)
def test_every_ingredient_can_be_changed_and_matters(drive: Run, name: str) -> None:
    usual = drive(controller="mpc", seed=GIVES_WAY, time_limit=SHORT)
    changed = drive(
        controller="mpc",
        seed=GIVES_WAY,
        time_limit=SHORT,
        controller_options={name: SWITCHES[name]},
    )
    assert changed.summary["frontal_contacts"] == 0
    assert len(speeds(changed)) == len(speeds(usual))
    assert np.abs(speeds(changed) - speeds(usual)).max() > 1e-6


@pytest.mark.parametrize(
    ("name", "seed", "until"), [("calm_time", 6, 12.0), ("threat_weight", 2, 16.0)]
)
def test_calm_speeds_matter_in_some_crowds(drive: Run, name: str, seed: int, until: float) -> None:
    usual = drive(controller="mpc", seed=seed, time_limit=until)
    changed = drive(controller="mpc", seed=seed, time_limit=until, controller_options={name: 0.0})
    both = min(len(speeds(usual)), len(speeds(changed)))
    assert np.abs(speeds(changed)[:both] - speeds(usual)[:both]).max() > 1e-6


def test_a_heavier_vehicle_of_another_fmu_has_its_own_mass() -> None:
    run = giveway.run(
        {
            "controller": "mpc",
            "seed": FREE,
            "time_limit": 4.0,
            "vehicle": {"fmu": "fmi3", "mass": 2000.0},
            "ego": {"initial_speed": 1.0},
        }
    )
    ego = run.ego_track
    assert ego.speed[-1] == pytest.approx(4.0, abs=0.2)
    assert ego.speed.max() < 4.05  # without overshoot: the plan knows the mass
    after = (1.0 - 100.0 * 0.05 / 2000.0) * ego.speed[:-1] + 0.05 / 2000.0 * ego.force[:-1]
    assert ego.speed[1:] == pytest.approx(after, abs=1e-3)


@pytest.mark.parametrize("scenario", ["street", "junction"])
def test_it_drives_in_streets_with_lights_and_cars(run_once: Run, scenario: str) -> None:
    run = run_once(controller="mpc", scenario=scenario, seed=1, time_limit=40.0)
    ego = run.ego_track
    assert ego.position[-1] > 20.0
    assert run.summary["frontal_contacts"] == 0
    assert ego.vehicle_gap.min() > 0.0
