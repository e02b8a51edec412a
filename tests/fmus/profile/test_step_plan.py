"""The controller's steps and the FMU's own: whole parts, whole multiples, and any others."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus import FmuProfileError
from fmus.profile.step_plan import StepPlan, between, make_step_plan

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
        (0.03, 5, 3),
        (0.07, 5, 7),
        (0.02, 5, 2),
        (1e9, 1, 20_000_000_000),
    ],
)
def test_steps_that_fit(fmu_step, substeps, stretch):
    step_plan = make_step_plan(H, fmu_step)
    assert (step_plan.substeps, step_plan.stretch) == (substeps, stretch)
    assert step_plan.step == pytest.approx(H if fmu_step is None else fmu_step, rel=1e-9)


@given(st.floats(0.001, 0.5), st.floats(0.001, 2.0), st.integers(0, 5000))
def test_any_other_step_reaches_every_instant_and_no_further(control_step, fmu_step, instant):
    """An instant lies within the last step, or at its end; the delay is never longer than told."""
    plan = make_step_plan(control_step, fmu_step)
    time, end = instant * control_step, plan.steps_until(instant) * plan.step
    slack = 1e-5 * plan.step
    assert time - slack <= end <= time + plan.delay + slack
    assert end - (1.0 - plan.share(instant)) * plan.step == pytest.approx(time, abs=slack)
    ended = [number * plan.substeps // plan.stretch for number in (instant, instant + 1)]
    assert plan.has_ended(instant + 1) == (ended[0] < ended[1])


@pytest.mark.parametrize(("fmu_step", "delay"), [(0.01, 0.0), (0.1, 0.05), (0.03, 0.02)])
def test_the_delay_is_the_longest_wait_for_a_step(fmu_step, delay):
    assert make_step_plan(H, fmu_step).delay == pytest.approx(delay)


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


@pytest.mark.parametrize("step", [0.03, 0.07, 0.1 / 3])
def test_an_fmu_does_its_own_steps_past_the_instants(clocked, step):
    """Its clock at each instant is the vehicle's time, by interpolation."""
    car = clocked(step, only_step=step, values={"friction": 0.0})
    car.start(speed=1.0)
    for k in range(1, 400):
        car.step(0.0)
        assert car.position == pytest.approx(k * H, abs=1e-9)


@pytest.mark.parametrize("step", [0.03, 0.07])
def test_a_force_acts_from_the_next_step_of_the_fmu_on(zoo, open_car, step):
    car = open_car(zoo.car(values={"friction": 0.0}), fmu={"step": step})
    car.start(position=5.0, speed=4.0)
    begins = [number * step for number in range(200)]
    force = [1000.0 * (number % 7 - 3) for number in range(100)]
    for k in range(100):
        car.step(force[k])
        held = [force[int(begin / H + 1e-9)] for begin in begins if begin < (k + 1) * H - 1e-9]
        over = len(held) * step - (k + 1) * H  # [s] by which the last step is ahead
        speed = 4.0 + (sum(held) * step - held[-1] * over) / 1000.0
        assert car.speed == pytest.approx(speed, abs=1e-9)


def test_driving_up_to_a_speed_leaves_its_clock_between_two_instants(zoo, open_car):
    car = open_car(zoo.car(initial=(), strict_time=True), fmu={"step": 0.03})
    car.start(position=7.0, speed=4.0)
    assert (car.time, car.position) == (0.0, 7.0)
    assert car.speed == pytest.approx(4.0, abs=0.01)
    for _ in range(19):
        before = car.position, car.speed
        car.step(400.0)
        way = 0.5 * H * (before[1] + car.speed)
        assert car.position - before[0] == pytest.approx(way, abs=1e-4)
    assert car.time == 19 * H


# ---- an FMU that knows its step itself ----


@pytest.mark.parametrize("fixed", [0.01, 0.02, 0.05, 0.1])
def test_a_fixed_internal_step_is_found_in_the_description(zoo, open_car, fixed):
    car = open_car(zoo.car(fmi="3.0", only_step=fixed), fmu={"step": fixed if fixed < H else None})
    car.start()
    positions = [car.position]
    for _ in range(8):
        car.step(1000.0)
        positions.append(car.position)
    assert all(b > a for a, b in pairwise(positions))


@pytest.mark.parametrize("fixed", ["1e-320", "0", "nan", "-1"])
def test_a_fixed_internal_step_that_means_nothing_is_none(zoo, open_car, redescribed, fixed):
    path = zoo.car(fmi="3.0", only_step=0.05)
    odd = redescribed(path, 'fixedInternalStepSize="0.05"', f'fixedInternalStepSize="{fixed}"')
    car = open_car(odd, like=path, fmu={"step": None})
    car.start()
    car.step(1000.0)
    assert car.speed > 0.0


# ---- an FMU that does steps of one length only, and tells it by its default experiment ----


@pytest.mark.parametrize("only", [0.01, 0.03, 0.05, 0.1])
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


def test_the_default_step_of_an_fmu_that_can_do_any_is_none(zoo, open_car):
    assert open_car(zoo.car(step=0.03)).prepared.step_plan.step == H


def test_a_step_of_the_profile_comes_first(zoo, open_car):
    car = open_car(zoo.car(only_step=0.03), fmu={"step": 0.025})
    assert car.prepared.step_plan.step == 0.025


def test_the_dead_times_of_the_model_include_its_steps(zoo, open_car):
    """A force waits up to 20 ms for an FMU step of 30 ms; the fit has seen the mean of 10 ms."""
    side = {"mass": 900.0, "delay": 0.1}
    fit = {"r_squared": 1.0, "speed_error": 0.0, "position_error": 0.0, "horizon": 0.75}
    model = {"mass": 1000.0, "friction": 1.0, "delay": 0.3, "time_step": H, "brake": side, **fit}
    late = open_car(zoo.car(), fmu={"step": 0.03}, model=model).prepared.fitted
    assert [late.delay, late.brake.delay] == pytest.approx([0.31, 0.11])
    assert late.drive is None
    assert open_car(zoo.car(), model=model).prepared.fitted.delay == 0.3
    assert open_car(zoo.car(), fmu={"step": 0.03}).prepared.fitted is None
