"""The exported controller's numbers are those of giveway's own regulator."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.random import Generator, default_rng

import giveway
from controller import Decision, Observation, SpeedController
from fmus.sources.export import bundled_controller
from fmus.sources.parameters import ControllerParameters

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

FORCE_TOLERANCE = 1e-7  # [N] the plans agree to about 1e-12 m/s, M/dt times that

INFEASIBILITY = {
    "": 0,
    "solved": 0,
    "infeasible: too close": 1,
    "infeasible: speed bounds": 2,
    "infeasible: cannot stop": 3,
    "infeasible: cannot hold speed": 4,
    "infeasible: certified": 5,
}


def assert_same(host: Any, decision: Decision, where: object) -> None:
    acting = {"mpc": 1, "pid": 2}[decision.acting]
    assert host.get("acting") == acting, where
    assert host.get("feasible") == (acting == 1), where
    assert host.get("infeasibility") == INFEASIBILITY[decision.status], where
    assert abs(host.get("force") - decision.force) <= FORCE_TOLERANCE, where
    assert host.get("reference_speed") == pytest.approx(decision.reference_speed, abs=1e-12)


def random_parameters(random: Generator, **fixed: Any) -> ControllerParameters:
    values: dict[str, Any] = {
        "mass": random.uniform(500, 3000),
        "friction": random.uniform(0, 400),
        "time_step": float(random.choice([0.02, 0.05, 0.1])),
        "reference_speed": random.uniform(1, 12),
        "safe_distance": random.uniform(0, 10),
        "margin": float(random.choice([0.0, 0.3])),
        "buffer_distance": random.uniform(3, 15),
        "speed_min": float(random.choice([0.0, 0.0, 1.0])),
        "speed_max": random.uniform(3, 20),
        "force_limit": random.uniform(2000, 10000),
        "force_rate_limit": random.uniform(300, 5000),
        "horizon": int(random.integers(2, 40)),
    }
    return ControllerParameters(**(values | fixed))


def meetings(
    random: Generator, p: ControllerParameters, steps: int, act: Callable[[Observation], float]
) -> Iterator[int]:
    """A car that follows ``act`` meets walkers who come and go, and lights."""
    position, speed = 0.0, random.uniform(0, 8)
    obstacle, walks, present = random.uniform(5, 30), random.normal(0, 1.5), True
    ahead = p.time_step * np.arange(1, p.horizon + 1)
    decay = 1 - p.friction * p.time_step / p.mass
    for k in range(steps):
        if random.random() < 0.05:
            present, walks = not present, random.normal(0, 1.5)
            obstacle = position + random.uniform(2, 25)
        predicted = obstacle + walks * ahead if present else np.full(p.horizon, np.inf)
        if random.random() < 0.2:
            predicted = predicted + random.normal(0, 0.2, p.horizon)
        gap = obstacle - position if present else np.inf
        limit = float(random.choice([np.inf, np.inf, 2.0, 0.0]))
        force = act(Observation(position, speed, gap, predicted, limit))
        yield k
        position += p.time_step * speed
        speed = max(decay * speed + p.time_step / p.mass * force, 0.0)
        obstacle += walks * p.time_step


def test_in_thousands_of_decisions_with_any_parameters(
    fmi_version: str, new_host: Callable[..., Any], regulator_of: Callable[..., SpeedController]
) -> None:
    statuses = set()
    for case in range(15):
        random = default_rng([case, int(fmi_version[0])])
        p = ControllerParameters() if case == 0 else random_parameters(random)
        host, regulator = new_host(fmi_version, p), regulator_of(p)

        def act(
            observation: Observation,
            host: Any = host,
            own: SpeedController = regulator,
            case: int = case,
        ) -> float:
            host.see(observation)
            decision = own.control(observation)
            assert_same(host, decision, (case, observation))
            statuses.add(decision.status)
            return decision.force

        for k in meetings(random, p, 150, act):
            host.step(k * p.time_step, p.time_step)
    assert statuses >= {"solved", *list(INFEASIBILITY)[2:5]}


@pytest.mark.parametrize("horizon", [2, 200])
def test_at_the_shortest_and_the_longest_horizon(
    horizon: int, new_host: Callable[..., Any], regulator_of: Callable[..., SpeedController]
) -> None:
    p = ControllerParameters(horizon=horizon, safe_distance=2.0)
    host, regulator = new_host("3.0", p), regulator_of(p)

    def act(observation: Observation) -> float:
        host.see(observation)
        decision = regulator.control(observation)
        assert_same(host, decision, observation)
        return decision.force

    for k in meetings(default_rng(7), p, 40, act):
        host.step(k * p.time_step, p.time_step)


def test_with_the_pid_alone(
    fmi_version: str, new_host: Callable[..., Any], regulator_of: Callable[..., SpeedController]
) -> None:
    p = ControllerParameters(mpc=False)
    host, regulator = new_host(fmi_version, p), regulator_of(p)

    def act(observation: Observation) -> float:
        host.see(observation)
        decision = regulator.control(observation)
        assert host.get("force") == decision.force  # not one bit differs
        assert host.get("acting") == 2
        assert host.get("infeasibility") == 0
        return decision.force

    for k in meetings(default_rng(1), p, 200, act):
        host.step(k * p.time_step, p.time_step)


@pytest.fixture(scope="module", params=[3, 4])
def real_run(request: pytest.FixtureRequest) -> list[tuple[Observation, Decision]]:
    """What the regulator saw and did in a run with SUMO, the vehicle FMU and the crowd."""
    record: list[tuple[Observation, Decision]] = []
    control = SpeedController.control

    def note(self: SpeedController, observation: Observation) -> Decision:
        own = observation.replaced(obstacle_positions=observation.obstacle_positions.copy())
        decision = control(self, observation)
        record.append((own, decision))
        return decision

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(SpeedController, "control", note)
        settings = {"scenario": "shared_space", "controller": "mpc-paper", "seed": request.param}
        giveway.run(settings)
    return record


def test_in_real_runs(
    fmi_version: str, real_run: list[tuple[Observation, Decision]], new_host: Callable[..., Any]
) -> None:
    host = new_host(fmi_version)
    for k, (observation, decision) in enumerate(real_run):
        host.see(observation)
        assert_same(host, decision, k)
        host.step(k * 0.05, 0.05)
    assert len(real_run) > 200
    assert any(d.acting == "pid" for _, d in real_run)


def test_in_real_runs_under_another_master(
    real_run: list[tuple[Observation, Decision]], cosim: Callable[..., Any]
) -> None:
    # libcosim reads outputs after a step, when they are those of the step's beginning.
    master = cosim(0.05)
    controller = master.add(str(bundled_controller("2.0")), "controller")
    references = [1, 2, 3, 4, *range(100, 115)]
    for o, decision in real_run:
        values = [o.speed, o.position, o.gap, o.speed_limit, *o.obstacle_positions]
        force, reference_speed = master.step(controller, references, values, [5, 6])
        assert abs(force - decision.force) <= FORCE_TOLERANCE
        assert abs(reference_speed - decision.reference_speed) <= 1e-12
