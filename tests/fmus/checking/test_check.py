"""What the dry run says of cars that have something wrong."""

import numpy as np
import pytest

from fmus import bundled_fmu
from fmus.checking import check, expected_of, opener_of, openers_held, without_guards
from fmus.checking.manoeuvres import Trace
from fmus.checking.observations import holds
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.profile.vehicle_profile import make_profile


def checked(zoo, path, isolated=False, known=None, **changes):
    profile = make_profile(zoo.profile(path) | changes, "test")
    guarded, unguarded = (
        opener_of(path, step_size=0.05, profile=chosen, isolated=isolated)
        for chosen in (profile, without_guards(profile))
    )
    return check(
        guarded,
        expected_of(profile, **known or {}),
        step_size=0.05,
        unguarded=unguarded,
        held=openers_held(path, step_size=0.05, profile=without_guards(profile), isolated=isolated),
    )


def finding(report, name):
    return next(found for found in report.findings if found.name == name)


def of(opener, **settings):
    return check(opener, expected_of(**settings), step_size=0.05)


@pytest.mark.parametrize(
    "role", ["force", "drive_brake", "acceleration", "throttle_brake", "speed_setpoint"]
)
def test_a_good_car_passes_in_every_role(zoo, role):
    report = checked(zoo, zoo.car(role=role))
    assert report.passed, [found for found in report.findings if found.verdict == "fail"]
    assert set(report.traces) == {"idle", "response", "again", "rolling"}


def test_ours_passes_without_a_warning():
    opener = opener_of(bundled_fmu(), step_size=0.05, profile=BUNDLED_PROFILE)
    report = of(opener, profile=BUNDLED_PROFILE)
    assert {found.verdict for found in report.findings} == {"pass"}


@pytest.mark.parametrize(
    ("spoken", "name", "seen"),
    [
        ({"speed": (1 / 3.6, 0.0)}, "speed and position", "0.2778 m per metre"),
        ({"position": (1000.0, 0.0)}, "speed and position", "0.001 m per metre"),
        ({"acceleration": (-1.0, 0.0)}, "acceleration", "-0.9975 times"),
    ],
)
def test_an_output_in_another_unit_than_declared(zoo, spoken, name, seen):
    found = finding(checked(zoo, zoo.car(spoken=spoken)), name)
    assert found.verdict == "fail"
    assert seen in found.text


def test_the_wrong_sign_of_the_force(zoo):
    report = checked(zoo, zoo.car(spoken={"force": (-1.0, 0.0)}))
    found = finding(report, "drives against coasting")
    assert found.verdict == "fail"
    assert "gain = -1.0" in found.remedy


def test_a_car_that_is_not_in_gear(zoo):
    report = checked(zoo, zoo.car(values={"engaged": 0.0}))
    found = finding(report, "drives against coasting")
    assert found.verdict == "fail"
    assert "no force moves it" in found.text


def test_a_car_that_creeps_and_one_that_nothing_holds(zoo):
    creeps = {"creep": 900.0}
    report = checked(zoo, zoo.car(role="throttle_brake", values=creeps))
    assert report.passed
    assert "creeps to 0.9" in finding(report, "stands still").text
    assert "hold it" in finding(report, "stays where it stopped").text
    report = checked(zoo, zoo.car(role="throttle_brake", values=creeps | {"holds": 0.0}))
    assert finding(report, "stays where it stopped").verdict == "fail"


def test_brakes_that_do_not_stop_it():
    step, still = 0.05, np.zeros(140)
    speed = np.maximum(4.0 - 3.0 * step * np.arange(141), 0.4)
    trace = Trace(step, still, np.zeros(141), speed, np.zeros(141), still, ())
    assert holds(trace, "brake").verdict == "fail"
    assert "0.4 m/s is left" in holds(trace, "brake").text


def test_a_filtered_speed_output_is_a_warning(zoo):
    car = zoo.car(outputs=("speed", "position"), values={"sensor_lag": 0.4}, file="filtered")
    report = checked(zoo, car)
    assert report.passed
    assert "0.4 s late: filtered" in finding(report, "speed and position").text


def test_brakes_that_reverse(zoo):
    late = zoo.car(values={"holds": 0.0, "lag": 0.2})
    assert finding(checked(zoo, late), "brakes hold").verdict == "warn"
    holds = checked(zoo, zoo.car(values={"holds": 1.0}))
    assert finding(holds, "brakes hold").verdict == "pass"


def test_another_mass_is_a_warning_that_leads_to_identify(zoo):
    report = checked(zoo, zoo.car(values={"mass": 1800.0}))
    found = finding(report, "controller's model")
    assert report.passed
    assert found.verdict == "warn"
    assert "M = 180" in found.text
    assert "giveway fmu identify" in found.remedy


def a_model(mass):
    return {
        "mass": mass, "friction": 100.0, "r_squared": 1.0, "speed_error": 0.0,
        "position_error": 0.0, "horizon": 0.75, "time_step": 0.05,
    }  # fmt: skip


def test_a_profile_with_the_model_passes_it(zoo):
    report = checked(zoo, zoo.car(values={"mass": 1800.0}), model=a_model(1804.5))
    assert finding(report, "controller's model").verdict == "pass"


# ---- a vehicle of which nothing is told ----


def test_a_lorry_is_judged_by_a_quick_identification(zoo):
    """8,000 N hardly brake 12 t; a run without a flag for the mass brakes it as a lorry."""
    lorry = zoo.car(role="drive_brake", values={"mass": 12_000.0, "lag": 0.3})
    report = checked(zoo, lorry)
    assert report.passed
    assert report.expected.brake_force == pytest.approx(96_000.0, rel=0.02)
    assert "act 0.3 s late" in finding(report, "controller's model").text
    told = checked(zoo, lorry, known={"mass": 12_000.0})
    assert "8000 N brake it with 0.82 m/s2" in finding(told, "brakes against coasting").text


# ---- errors of factor ----


@pytest.mark.parametrize(
    ("known", "changes", "origin"),
    [
        ({"mass": 1000.0}, {}, "1000 kg (--mass)"),
        ({"vehicle_class": "passenger"}, {}, "500 to 3500 kg (--ego-class passenger)"),
        ({}, {"model": a_model(1000.0)}, "1000 kg ([model] of the profile)"),
        ({}, {}, "500 to 44000 kg (cars to lorries of 44 t)"),
    ],
)
def test_a_wrong_unit_fails_by_the_mass(zoo, known, changes, origin):
    report = checked(zoo, zoo.car(spoken={"force": (1000.0, 0.0)}), known=known, **changes)
    found = finding(report, "weighs what is told")
    assert found.verdict == "fail"
    assert origin in found.text


@pytest.mark.parametrize("known", [{"mass": 1000.0}, {"vehicle_class": "passenger"}])
def test_another_load_is_no_factor(zoo, known):
    path = zoo.car(values={"mass": 1400.0})
    assert checked(zoo, path, known=known).passed


def test_lag_and_limits_are_seen(car):
    found = finding(of(car(lag=0.3, drive_limit=4000.0)), "controller's model")
    assert found.verdict == "warn"
    assert "0.3 s late" in found.text
    assert "no more than 4000 N of drive force arrive" in found.text


def test_noise_is_not_reproducible(car):
    noisy = iter(range(30))

    def opener(_step):
        made = car(noise=0.01, seed=1)(None)
        seed = next(noisy)
        start = made.start

        def start_with_seed(**state):
            start(**state)
            made._random.bit_generator.advance(seed)

        made.start = start_with_seed
        return made

    assert finding(of(opener), "reproducible").verdict == "warn"
    assert finding(of(car(noise=0.01, seed=1)), "reproducible").verdict == "pass"


def test_a_coarse_solver_fails_with_the_step_that_mends_it(zoo):
    report = checked(zoo, zoo.car(euler=True, values={"lag": 0.02}))
    found = finding(report, "step halving")
    assert found.verdict == "fail"
    assert "step = 0.025" in found.remedy


@pytest.mark.parametrize(
    ("behaviour", "phase"),
    [("segfault", "step"), ("exit_0", "instantiate"), ("nan", "step"), ("error", "initialise"),
     ("fatal", "step"), ("discard_always", "step"), ("message_control", "step")],
)  # fmt: skip
def test_a_hostile_fmu_is_a_failed_check_in_one_line(zoo, behaviour, phase):
    ends_its_process = behaviour in {"segfault", "exit_0"}
    path = zoo.car(behaviour=behaviour, phase=phase, at=0.0)
    report = checked(zoo, path, isolated=ends_its_process)
    assert report.passed == (behaviour == "message_control")
    for found in report.findings:
        assert (found.text + found.remedy).isprintable()
