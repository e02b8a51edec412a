"""Steps that are too coarse are found; those of an honest first-order solver pass."""

from pathlib import Path

import pytest

from fmus import FmuCrashError, FmuOutputError, FmuStartError, bundled_fmu
from fmus.checking import (
    convergence,
    drive,
    opener_of,
    require_converged,
)
from fmus.checking.self_check import compare, manoeuvre
from fmus.profile.bundled import BUNDLED_PROFILE
from fmus.profile.vehicle_profile import make_profile

STEP = 0.05
PATH = Path("car.fmu")


def opener(zoo, path, **fmu):
    profile = make_profile(zoo.profile(path) | {"fmu": fmu}, "test")
    return opener_of(path, step_size=STEP, profile=profile, isolated=False)


@pytest.mark.parametrize("speed", [0.0, 4.0, 20.0])
def test_forward_euler_passes(speed):
    ours = opener_of(bundled_fmu(), step_size=STEP, profile=BUNDLED_PROFILE)
    result = require_converged(ours, STEP, path=bundled_fmu(), force=8000.0, start_speed=speed)
    assert result.finer == STEP / 2
    assert result.problem == ""


def test_euler_with_a_lag_of_four_steps_passes(zoo):
    path = zoo.car(euler=True, values={"lag": 0.2})
    assert not convergence(opener(zoo, path), STEP, start_speed=4.0).problem


def test_a_diverging_solver_is_named_with_the_step_that_mends_it(zoo):
    path = zoo.car(euler=True, values={"lag": 0.02})
    with pytest.raises(FmuOutputError) as caught:
        require_converged(opener(zoo, path), STEP, path=path, start_speed=4.0)
    message = str(caught.value)
    assert message.startswith(f"{path}: its steps of 50 ms do not converge")
    assert message.endswith("add `step = 0.025` to [fmu] of the profile")
    assert "\n" not in message


def test_the_step_that_is_advised_passes(zoo):
    path = zoo.car(euler=True, values={"lag": 0.02})
    advised = convergence(opener(zoo, path), STEP).advised
    assert advised is not None
    assert not convergence(opener(zoo, path, step=advised), advised).problem


def test_a_diverging_solver_that_leaves_all_bounds_is_named(zoo):
    path = zoo.car(euler=True, values={"lag": 0.005})
    result = convergence(opener(zoo, path), STEP)
    assert "its steps of 50 ms do not converge" in result.problem
    assert result.advised is not None
    assert result.advised <= 0.01


def test_an_fmu_that_does_one_step_only_cannot_be_compared(zoo):
    path = zoo.car(only_step=STEP)
    result = convergence(opener(zoo, path), STEP)
    assert result.finer is None
    assert not result.problem


def test_an_fmu_with_its_own_steps_is_compared_with_whole_ones(zoo):
    path = zoo.car(role="drive_brake")
    result = convergence(opener(zoo, path, step=0.01), 0.01)
    assert result.finer == 0.005
    assert not result.problem


@pytest.mark.parametrize("behaviour", ["nan", "huge", "jump", "error"])
def test_a_fault_that_no_step_changes_is_reported_as_what_it_is(zoo, behaviour):
    path = zoo.car(behaviour=behaviour, at=0.5)
    with pytest.raises(Exception, match=r"speed|position|error") as caught:
        convergence(opener(zoo, path), STEP)
    assert "converge" not in str(caught.value)


def test_a_crash_ends_it_at_once(zoo):
    path = zoo.car(behaviour="abort", at=0.2)
    profile = make_profile(zoo.profile(path), "test")
    with pytest.raises(FmuCrashError):
        convergence(opener_of(path, step_size=STEP, profile=profile), STEP)


def test_what_does_not_start_is_tried_once(zoo):
    path = zoo.car(behaviour="error", phase="initialise", at=0.0)
    opened = []

    def counting(step):
        opened.append(step)
        return opener(zoo, path)(step)

    with pytest.raises(FmuStartError):
        convergence(counting, STEP)
    assert opened == [None]


def test_a_vehicle_is_opened_once_for_each_size_of_steps(zoo):
    """And drives from rest and from its start speed as a fresh one does."""
    path = zoo.car()
    opened = []

    def counting(step):
        opened.append(step)
        return opener(zoo, path)(step)

    result = convergence(counting, STEP, start_speed=4.0)
    assert opened == [None, STEP / 2]
    fresh = drive(opener(zoo, path), manoeuvre(4000.0), speed=4.0)
    assert result.traces[0].same_motion(fresh)


def test_the_comparison_sees_a_tenth_of_the_speed_and_the_way(car):
    light, heavy = (drive(car(mass=mass), manoeuvre(4000.0)) for mass in (800.0, 1000.0))
    found = compare(light, heavy)
    assert found is not None
    assert found.quantity in ("speed", "position")
    assert compare(heavy, heavy) is None
