"""What the paper's MPC does to the car: facts that follow from its parameters."""

from __future__ import annotations

import numpy as np
import pytest

from controller import LongitudinalModel, Mpc, MpcParameters

MODEL = LongitudinalModel()


def drive(mpc, speed, previous, obstacle, steps):
    """Speeds, positions, and the status of the step that had no plan, if one had not."""
    N = mpc.parameters.horizon
    position, speeds, positions = 0.0, [speed], [0.0]
    for _ in range(steps):
        solution = mpc.solve(
            position, speed, previous if speed > 1e-9 else 0.0, np.full(N, obstacle)
        )
        if not solution.found:
            return np.array(speeds), np.array(positions), solution.status
        previous = solution.force
        position += MODEL.time_step * speed
        speed = max(0.0, MODEL.decay * speed + MODEL.speed_per_force * previous)
        speeds.append(speed)
        positions.append(position)
    return np.array(speeds), np.array(positions), None


def test_from_rest_the_speed_peaks_above_the_reference():
    speeds, _, failure = drive(Mpc(MODEL), 0.0, 0.0, np.inf, 200)
    assert failure is None
    assert speeds.max() == pytest.approx(4.1759, abs=1e-4)
    assert speeds[-1] == pytest.approx(4.0, abs=1e-9)


@pytest.mark.parametrize(("horizon", "expected"), [(15, 1.777), (20, 1.802), (30, 1.802)])
def test_the_stopping_gap_from_4_m_per_s(horizon, expected):
    """1.80 m when the horizon sees the whole stop; the paper's 15 steps see a little less."""
    mpc = Mpc(MODEL, MpcParameters(horizon=horizon))
    low, high = 0.0, 5.0
    while high - low > 1e-4:
        gap = 0.5 * (low + high)
        found = mpc.solve(0.0, 4.0, 400.0, np.full(horizon, 8.0 + gap)).found
        low, high = (low, gap) if found else (gap, high)
    assert high == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("speed", [1.0, 4.0, 6.0, 7.0])
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.7])
def test_it_stops_behind_a_static_pedestrian_always_feasible(speed, offset):
    mpc = Mpc(MODEL, MpcParameters(reference_speed=speed))
    obstacle = 18.0 + offset * speed * MODEL.time_step
    steps = int(20.0 * (18.0 / speed)) + 60
    speeds, positions, failure = drive(mpc, speed, 100.0 * speed, obstacle, steps)
    assert failure is None
    assert speeds[-1] == pytest.approx(0.0, abs=1e-3)
    assert (positions <= obstacle - 8.0 + 1e-6).all()
    assert positions[-1] == pytest.approx(obstacle - 8.0, abs=0.3)


@pytest.mark.parametrize(("horizon", "speed"), [(10, 3.75), (15, 8.25), (20, 12.75)])
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.7])
def test_up_to_top_speed_a_horizon_sees_static_people_in_time(horizon, speed, offset):
    """Position never makes it infeasible; releasing the brake in time (c2 against c5) may."""
    mpc = Mpc(MODEL, MpcParameters(horizon=horizon, reference_speed=speed))
    obstacle = 30.0 + offset * speed * MODEL.time_step
    steps = int(20.0 * (30.0 / speed)) + 60
    speeds, _, failure = drive(mpc, speed, 100.0 * speed, obstacle, steps)
    assert failure in (None, "infeasible: cannot hold speed", "infeasible: speed bounds")
    assert speeds[-1] < 1.5


def test_beyond_that_speed_it_does():
    mpc = Mpc(MODEL, MpcParameters(reference_speed=9.0))
    _, positions, failure = drive(mpc, 9.0, 900.0, 80.0, 300)
    assert failure == "infeasible: cannot stop"
    assert positions[-1] < 72.0


@pytest.mark.parametrize("speed", [5.0, 12.0, 20.0])
def test_comes_down_from_any_speed_to_the_reference(speed):
    speeds, _, failure = drive(Mpc(MODEL), speed, 100.0 * speed, np.inf, 150)
    assert failure is None
    assert speeds[-1] == pytest.approx(4.0, abs=1e-6)
