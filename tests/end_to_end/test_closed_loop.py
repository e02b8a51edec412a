"""The loop on the real SUMO, FMU and solver, replayed part by part from its own rows."""

from collections.abc import Callable

import numpy as np
import pytest

import giveway
from controller import (
    LongitudinalModel,
    Mpc,
    MpcParameters,
    Observation,
    Pid,
    PidParameters,
    SpeedController,
)
from giveway.api import RunResult
from giveway.run_data.progress import Ending
from pedestrian_model import SIM, Crowd, CrowdModel, Predictor, Vehicles

Run = Callable[..., RunResult]
LENGTH, WIDTH, TIME_STEP = 5.0, 2.0, 0.05
SEED = 4  # a crowd that makes the MPC give way, and fall back to the PID, without a stop


@pytest.fixture(scope="module")
def mpc_run(run_once: Run) -> RunResult:
    return run_once(controller="mpc-paper", seed=SEED)


@pytest.fixture(scope="module")
def pid_run(run_once: Run) -> RunResult:
    return run_once(controller="pid-paper", seed=SEED)


def positions(run: RunResult, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Indices, positions and velocities of the pedestrians present at step k."""
    crowd = run.crowd_track
    here = crowd.step == k
    return (
        crowd.pedestrian[here],
        np.column_stack([crowd.x[here], crowd.y[here]]),
        np.column_stack([crowd.vx[here], crowd.vy[here]]),
    )


def ego_vehicle(run: RunResult, k: int) -> Vehicles:
    ego = run.ego_track
    half = LENGTH / 2
    centre = ego.front_x[k] - half
    return Vehicles.create(centre, ego.front_y[k], ego.heading[k], ego.speed[k], half, half, WIDTH)


def test_the_run_completes_its_forty_metres(mpc_run: RunResult) -> None:
    assert mpc_run.ending is Ending.COMPLETED
    assert mpc_run.ego_track.position[-2] < 40 <= mpc_run.ego_track.position[-1]
    assert 10 < mpc_run.summary["completion_time"] < 30


def test_time_is_a_multiple_of_the_step(mpc_run: RunResult) -> None:
    time = mpc_run.ego_track.time
    assert np.array_equal(time, np.arange(len(time)) * TIME_STEP)


def test_the_vehicle_follows_the_papers_recursion(mpc_run: RunResult) -> None:
    # x(k+1) = A x(k) + B u(k), Yang & Özgüner 2019, eq. (3)
    ego = mpc_run.ego_track
    x_1, x_2 = 0.0, 4.0
    for k in range(len(ego.time)):
        assert abs(ego.position[k] - x_1) < 1e-12
        assert abs(ego.speed[k] - x_2) < 1e-12
        x_1, x_2 = (
            x_1 + TIME_STEP * x_2,
            max((1 - 100 * TIME_STEP / 1000) * x_2 + TIME_STEP / 1000 * ego.force[k], 0.0),
        )


def test_the_crowd_follows_the_model_under_the_ego_at_t_k(mpc_run: RunResult) -> None:
    model = CrowdModel(SIM, TIME_STEP)
    present, position, velocity = positions(mpc_run, 0)
    speed = np.hypot(*velocity.T)
    goals = [point[None] + (0, 30) for point in position]
    crowd = Crowd.create(position, velocity, speed, goals)
    for k in range(1, 100):
        crowd = model.step(crowd, ego_vehicle(mpc_run, k - 1))
        present, position, velocity = positions(mpc_run, k)
        assert len(present) == 30
        assert np.abs(crowd.position - position).max() < 1e-12
        assert np.abs(crowd.velocity - velocity).max() < 1e-12


def in_front(position: np.ndarray, front: float) -> float:
    """x_p by its definition, in plain numpy."""
    ahead = position[(position[:, 0] > front) & (np.abs(position[:, 1]) <= 1.25), 0]
    return float(ahead.min()) if len(ahead) else np.inf


def test_the_controller_acts_on_the_state_at_t_k_without_lag(mpc_run: RunResult) -> None:
    # Everything is predicted here, without the loop's gate, which must not change a bit.
    regulator = SpeedController(
        Mpc(LongitudinalModel(), MpcParameters()), Pid(PidParameters(), TIME_STEP)
    )
    predictor = Predictor(SIM, TIME_STEP, 15)
    ego = mpc_run.ego_track
    _, start, velocity = positions(mpc_run, 0)
    desired_speed = np.hypot(*velocity.T)
    for k in range(len(ego.time)):
        present, position, velocity = positions(mpc_run, k)
        goals = [start[i][None] + (0, 30) for i in present]
        crowd = Crowd.create(position, velocity, desired_speed[present], goals)
        vehicles = np.repeat(ego_vehicle(mpc_run, k).array[None], 15, axis=0)
        vehicles[:, :, 0] += ego.speed[k] * TIME_STEP * np.arange(15)[:, None]  # it drives along +x
        predicted = predictor.predict(crowd, vehicles)
        front, speed = ego.position[k] + 2.5, ego.speed[k]
        x_p = [in_front(predicted[i], front + speed * TIME_STEP * (i + 1)) for i in range(15)]
        gap = in_front(position, front) - front
        assert ego.gap[k] == pytest.approx(gap, abs=1e-9)
        decision = regulator.control(Observation(front, speed, gap, np.array(x_p)))
        assert decision.acting == ego.controller[k]
        assert decision.force == pytest.approx(ego.force[k], abs=1.0)


def test_mpc_and_pid_meet_the_same_crowd(mpc_run: RunResult, pid_run: RunResult) -> None:
    for one, other in zip(positions(mpc_run, 0), positions(pid_run, 0), strict=True):
        assert np.array_equal(one, other)


def test_a_pid_run_never_lets_the_mpc_act(pid_run: RunResult) -> None:
    assert set(pid_run.ego_track.controller) == {"pid"}
    assert np.isnan(pid_run.summary["mpc_feasibility_rate"])


def test_the_mpc_falls_back_to_the_pid_and_says_why(mpc_run: RunResult) -> None:
    ego = mpc_run.ego_track
    assert set(ego.controller) == {"mpc", "pid"}
    assert set(ego.reason[ego.controller == "mpc"]) == {"optimal"}
    assert "optimal" not in set(ego.reason[ego.controller == "pid"])


def test_sumos_step_length_does_not_touch_the_result(run_once: Run, mpc_run: RunResult) -> None:
    coarse = run_once(controller="mpc-paper", seed=SEED, sumo={"step_length": 1.0})
    assert np.array_equal(coarse.ego_track.position, mpc_run.ego_track.position)
    assert np.array_equal(coarse.crowd_track.x, mpc_run.crowd_track.x)
    assert np.array_equal(coarse.crowd_track.y, mpc_run.crowd_track.y)


def test_fmi_2_and_fmi_3_drive_alike(run_once: Run, mpc_run: RunResult) -> None:
    other = run_once(controller="mpc-paper", seed=SEED, vehicle={"fmu": "fmi3"})
    assert np.array_equal(other.ego_track.position, mpc_run.ego_track.position)
    assert (
        other.manifest["vehicles"]["ego"]["sha256"] != mpc_run.manifest["vehicles"]["ego"]["sha256"]
    )


def test_an_empty_plaza_takes_ten_seconds_by_mpc() -> None:
    result = giveway.run({"controller": "mpc-paper", "crowd": {"pedestrians": 0}})
    assert result.summary["completion_time"] == pytest.approx(10.0, abs=0.01)
    assert result.summary["mpc_feasibility_rate"] == 1.0
    assert len(result.pedestrians) == 0


def test_the_pids_steady_state_error_delays_it_on_an_empty_plaza() -> None:
    # 10.39 s: e decays from alpha v_r / (K_p + alpha) = 0.16 m/s with (K_p + alpha) / K_i = 250 s
    result = giveway.run({"controller": "pid-paper", "crowd": {"pedestrians": 0}})
    assert result.summary["completion_time"] == pytest.approx(10.39, abs=0.01)


def test_people_cross_before_a_standing_car_but_for_the_detour() -> None:
    """The car stops; who cannot see a way round it does not walk before it, and it waits less."""
    settings = {
        "controller": "pid-paper",
        "seed": 3,
        "time_limit": 20.0,
        "crowd": {"pedestrians": 30},
    }
    waits = [
        giveway.run({**settings, "model_options": {"detour": detour}}).summary["longest_wait"]
        for detour in (True, False)
    ]
    assert waits[0] > waits[1] > 1.0


def test_the_ledger_adds_up_and_who_arrives_leaves(run_once: Run) -> None:
    crowd = {"pedestrians": 12, "walk": (0.0, 6.0)}
    result = run_once(crowd=crowd, seed=2)
    ledger = result.manifest["pedestrians"]
    assert ledger["added"] == 12 == ledger["arrived"] + ledger["walking"]
    assert ledger["arrived"] > 0
    last = result.crowd_track.step == len(result.ego_track.time) - 1
    assert last.sum() == ledger["walking"]


def test_two_sided_crowds_come_from_both_sides(run_once: Run) -> None:
    result = run_once(crowd={"two_sided": True}, seed=3)
    _, position, velocity = positions(result, 0)
    assert (position[::2, 1] < 0).all()
    assert (position[1::2, 1] > 0).all()
    assert (velocity[::2, 1] > 0).all()
    assert (velocity[1::2, 1] < 0).all()


def test_the_time_limit_ends_a_run_that_does_not_arrive(run_once: Run) -> None:
    result = run_once(controller="mpc-paper", time_limit=2.0, seed=SEED)
    assert result.ending is Ending.TIME_LIMIT
    assert result.ego_track.time[-1] == pytest.approx(2.0)
    assert np.isnan(result.summary["completion_time"])


def test_the_street_has_traffic_of_its_own(run_once: Run) -> None:
    result = run_once(controller="mpc-paper", scenario="street", seed=SEED)
    kinds = set(result.trajectories["type"])
    assert {"ego", "pedestrian"} < kinds
    cars = result.trajectories[~result.trajectories["type"].isin({"ego", "pedestrian"})]
    assert cars["id"].nunique() >= 2
    assert result.ending is Ending.COMPLETED


def street_vehicles(run: RunResult, k: int, *, cars: bool) -> Vehicles:
    """The ego and, on SUMO's latest instant and straight on since, the street's cars."""
    ego, track = run.ego_track, run.background_track
    half = LENGTH / 2
    rows = [
        (
            ego.front_x[k] - half * np.cos(ego.heading[k]),
            ego.front_y[k] - half * np.sin(ego.heading[k]),
            ego.heading[k],
            ego.speed[k],
            half,
            half,
            WIDTH,
        )
    ]
    latest = track.time[track.time <= ego.time[k] + 1e-9].max()
    for b in np.flatnonzero(track.time == latest) if cars else ():
        back = track.speed[b] * (ego.time[k] - latest) - track.length[b] / 2
        rows.append(
            (
                track.x[b] + back * np.cos(track.heading[b]),
                track.y[b] + back * np.sin(track.heading[b]),
                track.heading[b],
                track.speed[b],
                track.length[b] / 2,
                track.length[b] / 2,
                track.width[b],
            )
        )
    return Vehicles.create(*np.array(rows).T)


@pytest.mark.parametrize("cars", [True, False])
def test_the_streets_crowd_feels_its_cars(run_once: Run, cars: bool) -> None:
    # in SUMO's longer steps cars follow the street's bend: tests/giveway/cosimulation/test_bends.py
    sumo = {"step_length": 0.1}
    run = run_once(controller="mpc-paper", scenario="street", seed=SEED, sumo=sumo)
    model = CrowdModel(SIM, TIME_STEP)
    walking, position, velocity = positions(run, 0)
    goals = [point[None] + (0, 10) for point in position]
    crowd = Crowd.create(position, velocity, np.hypot(*velocity.T), goals)
    deviation = 0.0
    for k in range(1, 125):  # a westbound car comes through the crowd after 4 to 5 s
        crowd = model.step(crowd, street_vehicles(run, k - 1, cars=cars))
        present, position, _ = positions(run, k)
        crowd = crowd.select(np.isin(walking, present))  # without those who have arrived
        walking = present
        deviation = max(deviation, np.abs(crowd.position - position).max())
    assert deviation < 1e-9 if cars else deviation > 0.1


def test_the_gap_may_start_at_the_centre(run_once: Run) -> None:
    bumper = run_once(controller="pid-paper", seed=3, time_limit=8.0)
    centre = run_once(
        controller="pid-paper", seed=3, time_limit=8.0, controller_options={"gap_from": "centre"}
    )
    k = int(np.argmax(np.isfinite(bumper.ego_track.gap)))  # until then they drive alike
    assert np.isfinite(bumper.ego_track.gap[k])
    assert centre.ego_track.gap[k] == pytest.approx(bumper.ego_track.gap[k] + LENGTH / 2)


def test_the_scenarios_end_ends_the_run(run_once: Run) -> None:
    result = run_once(ego={"depart_time": 119.0}, crowd={"pedestrians": 0})
    assert result.ending is Ending.SCENARIO_END
    assert result.ego_track.time[-1] == pytest.approx(120.0)
