"""The controller's steps and the FMU's own: whole parts, whole multiples, nothing else."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus import FmuProfileError
from fmus.profile.step_plan import StepPlan, between, make_step_plan, step_to_run_with

H = 0.05  # [s]


# ---- how steps fit ----


@pytest.mark.parametrize(
    ("fmu_step", "substeps", "stretch"),
    [
        (None, 1, 1),
        (0.05, 1, 1),
        (0.05 * (1 + 1e-12), 1, 1),  # as it is written in decimals
        (0.01, 5, 1),
        (0.001, 50, 1),
        (0.05 / 3, 3, 1),
        (0.1, 1, 2),
        (0.15, 1, 3),
        (5.0, 1, 100),
    ],
)
def test_steps_that_fit(fmu_step, substeps, stretch):
    step_plan = make_step_plan(H, fmu_step)
    assert (step_plan.substeps, step_plan.stretch) == (substeps, stretch)
    assert step_plan.step == pytest.approx(H if fmu_step is None else fmu_step, rel=1e-9)


@pytest.mark.parametrize(
    ("fmu_step", "advice"),
    [(0.03, "step = 0.025 "), (0.07, "step = 0.05 "), (0.02, "step = 0.025 ")],
)
def test_steps_that_do_not_fit_are_refused_with_one_that_does(fmu_step, advice):
    with pytest.raises(FmuProfileError, match=advice) as caught:
        make_step_plan(H, fmu_step)
    assert f"{fmu_step:g} s" in str(caught.value)
    assert "--time-step" in str(caught.value)
    make_step_plan(H, float(advice.removeprefix("step = ")))


@pytest.mark.parametrize("fmu_step", [1e-9, 1e-300, 5e-324])
def test_steps_beyond_all_measure_are_refused(fmu_step):
    with pytest.raises(FmuProfileError, match="times smaller"):
        make_step_plan(H, fmu_step)


@given(st.integers(1, 1000), st.floats(0.001, 0.5))
def test_every_whole_part_and_multiple_fits(number, control_step):
    parts, multiple = (make_step_plan(control_step, control_step / number),
                       make_step_plan(control_step, control_step * number))  # fmt: skip
    assert parts == StepPlan(control_step / number, substeps=number)
    assert multiple == StepPlan(control_step * number, stretch=number)


# ---- within a step that is longer than the controller's ----

heights = st.floats(-100.0, 100.0)


@given(heights, heights, st.floats(0, 30), st.floats(0, 30), st.floats(0.01, 2.0))
def test_both_ends_are_the_fmus(s_0, s_1, v_0, v_1, h):
    assert between((s_0, v_0), (s_1, v_1), h, 0.0) == (s_0, v_0)
    assert between((s_0, v_0), (s_1, v_1), h, 1.0) == pytest.approx((s_1, v_1), rel=1e-12)


@given(heights, st.floats(0, 30), st.floats(-8, 8), st.floats(0.01, 2.0), st.floats(0, 1))
def test_a_constant_acceleration_is_met_exactly(s, v, a, h, share):
    end = s + v * h + a * h * h / 2, v + a * h
    t = share * h
    expected = s + v * t + a * t * t / 2, v + a * t
    assert between((s, v), end, h, share) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(heights, heights, st.floats(0, 30), st.floats(0, 30), st.floats(0.1, 2.0))
def test_the_position_leaves_each_end_at_its_speed(s_0, s_1, v_0, v_1, h):
    ends, tiny = ((s_0, v_0), (s_1, v_1)), 1e-6
    first = (between(*ends, h, tiny)[0] - s_0) / (tiny * h)
    last = (s_1 - between(*ends, h, 1 - tiny)[0]) / (tiny * h)
    slack = 1e-4 * (1 + abs(s_1 - s_0) + v_0 + v_1) / h
    assert first == pytest.approx(v_0, abs=slack)
    assert last == pytest.approx(v_1, abs=slack)


# ---- FMUs ----


@pytest.fixture
def clocked(zoo, open_car):
    """Open a car that insists on exact times, with its own clock as a position [m]."""

    def opened(step, **options):
        outputs = ("speed", "position", "clock")
        path = zoo.car(outputs=outputs, strict_time=True, **options)
        clock = {"variable": "clock", "gain": 1.0}
        outputs = {"position": clock, "acceleration": None}
        limits = {"position_jump": 1e6}
        car = open_car(path, fmu={"step": step}, outputs=outputs, limits=limits)
        car.start()
        return car

    return opened


@pytest.mark.parametrize("step", [None, 0.01, 0.05 / 3])
@pytest.mark.parametrize("fmi", ["1.0", "2.0", "3.0"])
def test_time_in_the_fmu_is_the_vehicles(clocked, fmi, step):
    car = clocked(step, fmi=fmi, constant_step=True)
    for k in range(1, 2001):
        car.step(0.0)
        assert car.time == k * H
        assert car.position == pytest.approx(car.time, rel=1e-14)


@pytest.mark.parametrize("stretch", [2, 3, 7])
def test_a_longer_step_is_done_when_it_begins(clocked, stretch):
    """The FMU is at its end then; in between positions are interpolated."""
    car = clocked(stretch * H, only_step=stretch * H)
    for k in range(1, 10 * stretch + 1):
        car.step(0.0)
        assert car.time == k * H
        if k % stretch == 0:
            assert car.position == pytest.approx(car.time, rel=1e-14)


def test_substeps_are_finer_physics(zoo, open_car):
    """An Euler FMU with a lag diverges at 50 ms; its sub-steps follow its equation."""
    path = zoo.car(euler=True, values={"lag": 0.02})
    car = open_car(path, fmu={"step": 0.001})
    car.start()
    for _ in range(100):
        car.step(1000.0)
    assert car.speed == pytest.approx(10.0 * (1 - 2.718281828 ** (-0.1 * 4.98)), rel=1e-3)


def test_a_longer_step_holds_the_force_and_is_smooth_in_between(zoo, open_car):
    long, short = open_car(zoo.car(), fmu={"step": 0.2}), open_car(zoo.car())
    for car in (long, short):
        car.start(position=5.0, speed=4.0)
    for forces in ((2000.0, -9e9, 9e9, 0.0), (-3000.0, 1e9, 1e9, 1e9)):  # only the first is held
        for force in forces:
            long.step(force)
            short.step(forces[0])
            assert long.position == pytest.approx(short.position, abs=1e-5)
            assert long.speed == pytest.approx(short.speed, abs=2e-3)
        assert long.speed == pytest.approx(short.speed, abs=1e-12)


# ---- an FMU that knows its step itself ----


@pytest.mark.parametrize("fixed", [0.01, 0.05, 0.1])
def test_a_fixed_internal_step_is_found_in_the_description(zoo, open_car, fixed):
    car = open_car(zoo.car(fmi="3.0", only_step=fixed), fmu={"step": fixed if fixed < H else None})
    car.start()
    positions = [car.position]
    for _ in range(8):
        car.step(1000.0)
        positions.append(car.position)
    assert all(b > a for a, b in pairwise(positions))


def test_a_fixed_internal_step_that_does_not_fit_is_refused(zoo, open_car):
    """No step in [fmu] would help: the FMU has its own."""
    with pytest.raises(FmuProfileError, match=r"fixed step of 0\.02 s") as caught:
        open_car(zoo.car(fmi="3.0", only_step=0.02), fmu={"step": None})
    assert "--time-step" in str(caught.value)
    assert "[fmu]" not in str(caught.value)


@pytest.mark.parametrize("fixed", ["1e-320", "0", "nan", "-1"])
def test_a_fixed_internal_step_that_means_nothing_is_none(zoo, open_car, redescribed, fixed):
    path = zoo.car(fmi="3.0", only_step=0.05)
    odd = redescribed(path, 'fixedInternalStepSize="0.05"', f'fixedInternalStepSize="{fixed}"')
    car = open_car(odd, like=path, fmu={"step": None})
    car.start()
    car.step(1000.0)
    assert car.speed > 0.0


# ---- an FMU that does steps of one length only, and tells it by its default experiment ----


@pytest.mark.parametrize("only", [0.01, 0.05, 0.1])
@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_a_profile_without_a_step_has_the_default_experiments(
    zoo, open_car, redescribed, fmi, only
):
    path = zoo.car(fmi=fmi, only_step=only)
    plain = path
    if fmi == "3.0":
        plain = redescribed(path, f'fixedInternalStepSize="{only!r}"', "")
    car = open_car(plain, like=path, fmu={"step": None})
    assert car.prepared.step_plan.step == pytest.approx(only)
    car.start()
    for _ in range(4):
        car.step(1000.0)
    assert car.speed > 0.0


def test_a_default_step_that_does_not_fit_is_refused_at_set_up(zoo, open_car):
    path = zoo.car(only_step=0.03)
    with pytest.raises(FmuProfileError, match=r"0\.03 s, does not fit the control step of 0\.05 s"):
        open_car(path, fmu={"step": None})
    open_car(path, step=0.06, fmu={"step": None})


def test_the_default_step_of_an_fmu_that_can_do_any_is_none(zoo, open_car):
    assert open_car(zoo.car(step=0.03)).prepared.step_plan.step == H


def test_a_step_of_the_profile_comes_first(zoo, open_car):
    car = open_car(zoo.car(only_step=0.03), fmu={"step": 0.025})
    assert car.prepared.step_plan.step == 0.025


@pytest.mark.parametrize(
    ("fmu_step", "flag"), [(0.05, ""), (0.025, ""), (0.02, " and run with --time-step 0.02")]
)
def test_the_flag_that_a_run_needs_for_an_fmus_own_step(fmu_step, flag):
    assert step_to_run_with(fmu_step) == flag
