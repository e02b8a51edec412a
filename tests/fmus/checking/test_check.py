"""What the dry run says of cars that have something wrong, each with the line that mends it."""

import pytest

from fmus import bundled_fmu
from fmus.checking import check, expected_of, opener_of, without_guards
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.profile.vehicle_profile import make_profile


def checked(zoo, path, isolated=False, known=None, **changes):
    profile = make_profile(zoo.profile(path) | changes, "test")
    guarded, unguarded = (
        opener_of(path, step_size=0.05, profile=chosen, isolated=isolated)
        for chosen in (profile, without_guards(profile))
    )
    return check(guarded, expected_of(profile, **known or {}), step_size=0.05, unguarded=unguarded)


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
    assert set(report.traces) == {"idle", "response", "again", "rolling", "full"}


def test_ours_passes_without_a_warning():
    opener = opener_of(bundled_fmu(), step_size=0.05, profile=BUNDLED_PROFILE)
    report = of(opener, profile=BUNDLED_PROFILE)
    assert {found.verdict for found in report.findings} == {"pass"}


@pytest.mark.parametrize(
    ("spoken", "name", "remedy"),
    [
        ({"speed": (1 / 3.6, 0.0)}, "start speed", None),  # the parameter is named speed too
        ({"position": (1000.0, 0.0)}, "speed and position", 'unit = "km"'),
        ({"position": (0.3048, 0.0)}, "speed and position", 'unit = "ft"'),
        ({"acceleration": (9.80665, 0.0)}, "acceleration", "gain = 9.80665"),
        ({"acceleration": (-1.0, 0.0)}, "acceleration", "gain = -1.0"),
        ({"position": (-1.0, 0.0)}, "speed and position", "gain = -1.0"),
    ],
)
def test_an_output_in_another_unit_than_declared(zoo, spoken, name, remedy):
    report = checked(zoo, zoo.car(spoken=spoken))
    if remedy is None:
        name, remedy = "speed and position", 'unit = "km/h"'
    found = finding(report, name)
    assert found.verdict == "fail"
    assert remedy in found.remedy


def test_a_force_in_kilonewtons(zoo):
    report = checked(zoo, zoo.car(spoken={"force": (1000.0, 0.0)}))
    assert not report.passed
    assert finding(report, "controller's model").remedy == 'set `unit = "kN"` in [inputs.force]'


def test_the_wrong_sign_of_the_force(zoo):
    report = checked(zoo, zoo.car(spoken={"force": (-1.0, 0.0)}))
    found = finding(report, "drives")
    assert found.verdict == "fail"
    assert "gain = -1.0" in found.remedy
    assert "[inputs.force]" in found.remedy


def test_a_gain_that_is_there_already_is_not_advised(zoo):
    """The car is driven forwards by a positive force, and its profile turns the sign."""
    path = zoo.car()
    inputs = {"force": {"variable": "force", "gain": -1.0}}
    found = finding(checked(zoo, path, inputs=inputs), "drives")
    assert found.verdict == "fail"
    assert "`gain = 1.0` in place of `gain = -1.0` in [inputs.force]" in found.remedy
    path = zoo.car(spoken={"position": (-0.5, 0.0)})
    outputs = zoo.profile(path)["outputs"]
    outputs["position"]["gain"] = 2.0
    found = finding(checked(zoo, path, outputs=outputs), "speed and position")
    assert "set `gain = -0.5` in place of `gain = 2.0` in [outputs.position]" in found.remedy


def test_a_car_that_is_not_in_gear(zoo):
    report = checked(zoo, zoo.car(values={"engaged": 0.0}))
    found = finding(report, "drives")
    assert found.verdict == "fail"
    assert "does not move" in found.text


def test_brakes_that_reverse(zoo):
    late = zoo.car(values={"holds": 0.0, "lag": 0.2})
    assert finding(checked(zoo, late), "brakes").verdict == "warn"
    holds = checked(zoo, zoo.car(values={"holds": 1.0}))
    assert finding(holds, "brakes").verdict == "pass"


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


# ---- errors of factor ----


def per_cent(zoo):
    """A car whose pedals take per cent, and say that 1 is fully pressed."""
    spoken = {"throttle": (0.01, 0.0), "brake": (0.01, 0.0)}
    return zoo.car(role="throttle_brake", spoken=spoken)


@pytest.mark.parametrize(
    ("known", "changes", "origin"),
    [
        ({"mass": 1000.0}, {}, "1000 kg (--mass)"),
        ({"mass": 1400.0}, {}, "1400 kg (--mass)"),
        ({"vehicle_class": "passenger"}, {}, "500 to 3500 kg (--ego-class passenger)"),
        ({}, {"model": a_model(1000.0)}, "1000 kg ([model] of the profile)"),
        ({"mass": 1000.0}, {"model": a_model(1e5)}, "1000 kg (--mass)"),
    ],
)
def test_per_cent_pedals_declared_otherwise_fail_by_the_mass(zoo, known, changes, origin):
    found = finding(checked(zoo, per_cent(zoo), known=known, **changes), "controller's model")
    assert found.verdict == "fail"
    assert origin in found.text
    assert "100 times too weak" in found.text
    assert found.remedy == 'set `unit = "%"` in [inputs.throttle]'


def test_without_anything_to_compare_with_it_is_a_question(zoo):
    report = checked(zoo, per_cent(zoo))
    found = finding(report, "controller's model")
    assert found.verdict == "ask"
    assert "does it weigh 1e+05 kg?" in found.text
    assert "--mass" in found.remedy


@pytest.mark.parametrize(
    ("role", "spoken", "words", "remedy"),
    [
        ("force", {"force": (9.80665, 0.0)}, "9.81", 'unit = "kgf"'),
        ("force", {"force": (1 / 9.80665, 0.0)}, "9.81", 'unit = "N"'),
        ("force", {"force": (1e-2, 0.0)}, "factor of 100", "see `unit` and `gain`"),
        ("force", {"force": (0.2, 0.0)}, "5.0", "see `unit` and `gain`"),
        ("acceleration", {"wanted_acceleration": (9.80665, 0.0)}, "9.81", 'unit = "g0"'),
        ("force", {"speed": (1 / 3.6, 0.0), "initial_speed": (1 / 3.6, 0.0)}, "3.6", "km/h"),
        ("force", {"speed": (3.6, 0.0), "initial_speed": (3.6, 0.0)}, "3.6", 'unit = "m/s"'),
    ],
)
def test_a_factor_has_a_name(zoo, role, spoken, words, remedy):
    """Without a position nothing but the mass tells that the speed is in another unit."""
    path = zoo.car(role=role, spoken=spoken, outputs=("speed",))
    found = finding(checked(zoo, path, known={"mass": 1000.0}), "controller's model")
    assert found.verdict == "fail"
    assert words in found.text
    assert remedy in found.remedy


def test_a_set_point_without_its_lead_fails_with_the_lead(zoo):
    path = zoo.car(role="speed_setpoint")
    inputs = {"speed_setpoint": {"variable": "speed_setpoint"}}
    found = finding(checked(zoo, path, inputs=inputs), "controller's model")
    assert found.verdict == "fail"
    assert "`lead = 0.5" in found.remedy


@pytest.mark.parametrize("known", [{"mass": 1000.0}, {"vehicle_class": "passenger"}])
def test_another_load_is_no_factor(zoo, known):
    report = checked(zoo, zoo.car(values={"mass": 2400.0}), known=known)
    assert report.passed


def test_lag_and_limits_are_seen(car):
    report = of(car(lag=0.3, drive_limit=4000.0))
    assert finding(report, "actuator lag").verdict == "warn"
    assert "0.3 s late" in finding(report, "actuator lag").text
    assert "run it with --vehicle-force-limit" in finding(report, "force limits").remedy


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
