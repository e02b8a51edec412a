"""M, alpha, lag and dead time of cars that are known."""

import re
from pathlib import Path

import numpy as np
import pytest

from fmus import FmuOutputError, bundled_fmu
from fmus.checking import Mpc, identify, opener_of
from fmus.checking.manoeuvres import without_guards
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.profile.vehicle_profile import make_profile

PATH = Path("car.fmu")
SLOW_AND_FAST = (0.0, 4.0, 12.0)  # [m/s]


def identified(opener, step_size=0.05, force_limit=8000.0, speeds=SLOW_AND_FAST, **more):
    return identify(opener, Mpc(step_size, 15, force_limit), path=PATH, speeds=speeds, **more)


@pytest.mark.parametrize(
    ("mass", "friction", "step"),
    [(1000.0, 100.0, 0.05), (1523.5, 43.2, 0.02), (20_000.0, 0.0, 0.1)],
)
def test_our_plant_is_found_to_the_last_digits(mass, friction, step):
    opener = opener_of(
        bundled_fmu(), step_size=step, profile=BUNDLED_PROFILE,
        start_values={"M": mass, "alpha": friction},
    )  # fmt: skip
    found = identified(opener, step_size=step)
    assert found.model.mass == pytest.approx(mass, rel=1e-9)
    assert found.model.friction == pytest.approx(friction, rel=1e-9, abs=1e-9)
    assert found.model.lag == found.model.delay == 0.0
    assert found.model.r_squared == pytest.approx(1.0)
    assert found.model.position_error < 1e-9
    assert found.remarks == ()


def test_an_exact_plant_differs_by_its_discretisation_only():
    M, alpha, h = 1000.0, 100.0, 0.05
    opener = opener_of(
        bundled_fmu(), step_size=h, profile=BUNDLED_PROFILE, start_values={"exact": True}
    )
    found = identified(opener).model
    # v+ = e^-z v + (1 - e^-z) u / alpha, z = alpha h / M, read as forward Euler
    decay = np.exp(-alpha * h / M)
    assert found.mass == pytest.approx(h * alpha / (1.0 - decay), rel=1e-9)
    assert found.friction == pytest.approx(alpha, rel=1e-9)


@pytest.mark.parametrize(("lag", "delay"), [(0.2, 0.0), (0.0, 0.13), (0.3, 0.1)])
def test_lag_and_dead_time_are_told_apart(car, lag, delay):
    found = identified(car(lag=lag, delay=delay)).model
    assert found.lag == pytest.approx(lag, rel=0.05, abs=0.002)
    assert found.delay == pytest.approx(delay, rel=0.05, abs=0.002)
    assert found.mass == pytest.approx(1000.0, rel=0.005)
    assert found.friction == pytest.approx(100.0, rel=0.01)


def test_what_the_mpc_does_not_know_is_in_its_position_error(car):
    prompt, late = (identified(car(lag=lag)) for lag in (0.0, 0.3))
    assert prompt.model.position_error < 0.1
    assert late.model.position_error > 5 * prompt.model.position_error
    assert any("0.3 s late" in remark for remark in late.remarks)


def test_a_filtered_speed_output_is_allowed_for_in_the_errors(zoo):
    path = zoo.car(outputs=("speed", "position"), values={"sensor_lag": 0.3}, file="filtered")
    profile = without_guards(make_profile(zoo.profile(path), "test"))
    found = identified(opener_of(path, step_size=0.05, profile=profile, isolated=False)).model
    assert found.sensor_lag == pytest.approx(0.3, rel=0.02)
    assert found.lag == found.drive.lag == found.brake.lag == 0.0
    assert found.sides_error < 0.15  # 0.8 m from the output itself
    assert found.speed_error < 0.05


def test_the_intervals_hold_the_truth_for_a_noisy_car(car):
    found = identified(car(noise=0.02, lag=0.2))
    mass, friction = found.intervals
    assert 0.0 < mass < 20.0
    assert abs(found.model.mass - 1002.5) < 3.0 * mass  # as forward Euler sees 1000 kg
    assert abs(found.model.friction - 100.0) < 3.0 * friction


def test_saturation_is_reported_and_kept_out_of_the_fit(car):
    found = identified(car(drive_limit=3000.0, brake_limit=5000.0, lag=0.1))
    assert found.model.drive.limit * 1000.0 == pytest.approx(3000.0, rel=0.02)
    assert found.model.brake.limit * 1000.0 == pytest.approx(5000.0, rel=0.02)
    assert found.model.mass == pytest.approx(1000.0, rel=0.005)
    assert any("3000 N of drive force arrive" in remark for remark in found.remarks)


def test_a_car_without_limits_has_none(car):
    found = identified(car(drag=1.0)).model
    assert found.drive.limit is found.drive.power_from is found.drive.rate is None
    assert found.brake.limit is found.brake.rate is None


def test_resistance_that_is_not_linear_is_said_with_its_terms(car):
    quadratic, constant = identified(car(drag=3.0)), identified(car(constant=180.0))
    assert quadratic.model.r_squared > 0.9999
    (factor,) = re.findall(r"([\d.]+) N.s²/m² v²", " ".join(quadratic.remarks))
    assert float(factor) == pytest.approx(3.0, rel=0.1)
    (force,) = re.findall(r"([\d.]+) N \+", " ".join(constant.remarks))
    assert float(force) == pytest.approx(180.0, rel=0.05)
    assert "v²" not in " ".join(constant.remarks)


def test_weak_and_heavy_vehicles_are_tried_with_fitting_forces(car):
    assert identified(car(mass=80.0, friction=8.0)).largest_force < 800.0
    assert identified(car(mass=20_000.0)).largest_force == 8000.0


def test_an_acceleration_driven_vehicle_is_identified_as_a_whole(zoo):
    path = zoo.car(role="acceleration")
    profile = make_profile(
        zoo.profile(path) | {"inverse_map": {"mass": 1200.0, "friction": 50.0}}, "test"
    )
    found = identified(opener_of(path, step_size=0.05, profile=profile, isolated=False)).model
    assert found.mass == pytest.approx(1200.0, rel=0.01)
    assert found.r_squared > 0.99


def test_a_car_that_cannot_start_at_a_speed_is_driven_up_to_it(zoo):
    path = zoo.car(initial=())
    profile = make_profile(zoo.profile(path) | {"initial": {"run_up": False}}, "test")
    found = identified(
        opener_of(path, step_size=0.05, profile=profile, isolated=False), speeds=(0.0, 6.0)
    )
    assert found.model.mass == pytest.approx(1000.0, rel=0.005)
    assert found.model.friction == pytest.approx(100.0, rel=0.01)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"sign": -1.0, "friction": 0.0}, "does not drive off|backwards|expected a vehicle"),
        ({"drive_limit": 0.0, "brake_limit": 0.0}, "change its speed by 0 m/s"),
    ],
)
def test_what_is_no_vehicle_is_refused_in_one_line(car, parameters, words):
    with pytest.raises(FmuOutputError, match=words) as caught:
        identified(car(**parameters))
    assert str(caught.value).startswith("car.fmu: ")
    assert "\n" not in str(caught.value)


def test_progress_counts_every_drive(car):
    told = []
    identified(car(), progress=lambda done, total: told.append((done, total)))
    assert told[0] == (0, told[-1][1])
    assert told[-1][0] == told[-1][1] == 3 * 5 + 2
    assert told == sorted(told)


# ---- drive and brake apart ----


def remarks_of(found, words):
    return [remark for remark in found.remarks if words in remark]


def pedals(throttle=4000.0, brake=8000.0):
    inputs = {
        "throttle": {"variable": "t", "full_force": throttle},
        "brake": {"variable": "b", "full_force": brake},
    }
    return make_profile({"inputs": inputs, "outputs": {"speed": {"variable": "v"}}}, "test")


@pytest.mark.parametrize(("lag", "brake_lag"), [(0.4, 0.1), (0.05, 0.3)])
def test_drive_and_brake_have_a_lag_each(car, lag, brake_lag):
    found = identified(car(lag=lag, brake_lag=brake_lag))
    for side, true in ((found.model.drive, lag), (found.model.brake, brake_lag)):
        assert side.lag + side.delay == pytest.approx(true, rel=0.15, abs=0.02)
        assert side.mass == pytest.approx(1000.0, rel=0.03)
    (remark,) = remarks_of(found, "and brakes")
    assert remark.startswith("it drives ")


def test_a_brake_pedal_weaker_than_declared_is_told_the_line(car):
    found = identified(car(brake_gain=0.5), profile=pedals())
    assert found.model.drive.mass == pytest.approx(1000.0, rel=0.02)
    assert found.model.brake.mass == pytest.approx(2000.0, rel=0.03)
    (remark,) = remarks_of(found, "brakes like")
    strength, other = map(float, re.findall(r"full_force = ([\d.]+)", remark))
    assert strength == pytest.approx(4000.0, rel=0.05)
    assert other == pytest.approx(8000.0, rel=0.05)


def test_equal_sides_are_not_worth_a_word(car):
    found = identified(car(lag=0.2, drag=0.5, constant=100.0), profile=pedals())
    assert not remarks_of(found, "brakes")
