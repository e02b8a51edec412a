"""The tuned PID: no error, no overshoot, no jerk without need, and it stops in time."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from controller import (
    LongitudinalModel,
    Observation,
    ParameterError,
    ReferenceParameters,
    SpeedController,
    TunedPid,
    TunedPidParameters,
)
from fmus import VehicleFmu, bundled_fmu

DT = 0.05  # [s]
MODEL = LongitudinalModel()
MASSES = (700.0, 1000.0, 1300.0, 1500.0)  # [kg]
PROFILES = ("braking-curve", "linear")
EMPTY = np.full(15, math.inf)


def nobody(k, position):
    return math.inf


def standing_at(place):
    return lambda k, position: place - position


def drive(pid, speed, seconds, gap=nobody, *, mass=1000.0, limit=lambda k: math.inf):
    """Positions, speeds and forces of the real FMU under the PID."""
    with VehicleFmu(bundled_fmu(), step_size=DT, start_values={"M": mass}) as vehicle:
        vehicle.start(position=0.0, speed=speed)
        rows = []
        for k in range(round(seconds / DT)):
            force = pid.control(vehicle.speed, gap(k, vehicle.position), limit(k))
            rows.append((vehicle.position, vehicle.speed, force))
            vehicle.step(force)
    return np.array(rows).T


def jerk(speeds):
    return np.diff(speeds, 2) / DT**2


@pytest.mark.parametrize("known", [True, False], ids=["mass known", "mass unknown"])
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("start", [0.0, 2.0, 6.0])
def test_it_settles_at_the_reference_without_error_or_overshoot(mass, known, start):
    pid = TunedPid(model=replace(MODEL, mass=mass if known else 1000.0))
    _, speeds, _ = drive(pid, start, 15.0, mass=mass)
    beyond = (speeds - 4.0) * (1.0 if start < 4.0 else -1.0)
    assert beyond.max() < 0.02 * 4.0
    assert speeds[-1] == pytest.approx(4.0, abs=1e-4)


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("profile", PROFILES)
def test_it_stops_before_the_safe_distance_and_stays(profile, mass):
    pid = TunedPid(TunedPidParameters(reference=ReferenceParameters(profile=profile)))
    positions, speeds, _ = drive(pid, 4.0, 30.0, standing_at(40.0), mass=mass)
    assert 8.0 <= 40.0 - positions[-1] < 8.6
    assert speeds[-200:].max() < 1e-3


@pytest.mark.parametrize("profile", PROFILES)
def test_a_standing_car_drives_off_when_the_way_is_free(profile):
    pid = TunedPid(TunedPidParameters(reference=ReferenceParameters(profile=profile)))
    away = lambda k, position: math.inf if k > 600 else 40.0 - position  # noqa: E731
    _, speeds, _ = drive(pid, 4.0, 40.0, away)
    assert speeds[599] < 1e-3
    assert speeds[-1] == pytest.approx(4.0, abs=1e-3)


@pytest.mark.parametrize("mass", [1000.0, 1500.0])
def test_a_load_is_overcome(mass):
    """Half a kilonewton more against it than the model knows: a slope of five per cent."""
    pid, vehicle, v = TunedPid(), replace(MODEL, mass=mass), 4.0
    for _ in range(200):
        v = vehicle.decay * v + vehicle.speed_per_force * (pid.control(v, math.inf) - 500.0)
    assert v == pytest.approx(4.0, abs=1e-4)


def test_an_approach_keeps_to_comfort():
    p = ReferenceParameters()
    _, speeds, _ = drive(TunedPid(), 4.0, 20.0, standing_at(40.0))
    assert np.diff(speeds).min() / DT >= -p.deceleration - 1e-9
    assert np.abs(jerk(speeds)).max() <= p.jerk + 1e-9


def test_driving_off_keeps_to_comfort():
    p = ReferenceParameters()
    _, speeds, _ = drive(TunedPid(), 0.0, 10.0)
    assert np.diff(speeds).max() / DT <= p.acceleration + 1e-9
    assert np.abs(jerk(speeds)).max() <= p.jerk + 1e-9


@given(gap=st.floats(3.0, 7.9), mass=st.sampled_from(MASSES))
@settings(max_examples=40)
def test_who_steps_in_closely_is_braked_for_hard(gap, mass):
    """Within the actuator's limits the car stops before it is at the pedestrian."""
    steps_in = lambda k, position: math.inf if k < 20 else gap + 4.0 - position  # noqa: E731
    positions, speeds, _ = drive(TunedPid(), 4.0, 10.0, steps_in, mass=mass)
    assert speeds[-1] < 1e-3
    assert gap + 4.0 - positions[-1] > 0.5


def test_firm_braking_keeps_the_safe_distance_where_it_can():
    """Somebody 12 m ahead: comfort alone would end 4 m too near."""
    positions, speeds, _ = drive(TunedPid(), 4.0, 10.0, standing_at(12.0))
    assert 12.0 - positions[-1] > 7.9
    assert -np.diff(speeds).min() / DT < 3.5


def test_the_later_somebody_steps_in_the_harder_it_brakes():
    def strongest(gap):
        _, speeds, _ = drive(TunedPid(), 4.0, 6.0, standing_at(gap))
        return -np.diff(speeds).min() / DT

    found = [strongest(gap) for gap in (3.0, 4.0, 5.0, 6.0, 7.5, 20.0)]
    assert all(near >= far - 1e-9 for near, far in pairwise(found))
    assert found[0] > 7.0
    assert found[-1] <= ReferenceParameters().deceleration + 1e-9


moments = st.tuples(
    st.floats(0.0, 20.0),
    st.floats(-2.0, 60.0) | st.just(math.inf),
    st.floats(0.0, 10.0) | st.just(math.inf),
)


@given(moments=st.lists(moments, min_size=1, max_size=40))
@settings(max_examples=150)
def test_the_actuators_limits_hold_whatever_is_seen(moments):
    pid, before = TunedPid(), 0.0
    for speed, gap, limit in moments:
        force = pid.control(speed, gap, limit)
        assert abs(force) <= 8000.0
        if speed > 1e-9 and limit > 0.0:
            assert abs(force - before) <= 1000.0 + 1e-6
        before = force


def test_a_limit_of_zero_stops_it_and_it_never_drives_on():
    positions, speeds, forces = drive(
        TunedPid(), 4.0, 30.0, limit=lambda k: 0.0 if k >= 40 else 9.0
    )
    assert speeds[-1] < 1e-9
    stood = int(np.argmax(speeds < 1e-3))
    assert forces[60:].max() <= 0.0
    assert positions[-1] - positions[stood] < 1e-3


def test_a_falling_limit_is_followed():
    """As before a red light: sqrt(2 b d) with b = 2 m/s^2 to a line after 30 m."""
    pid, x, v = TunedPid(), 0.0, 4.0
    for _ in range(400):
        limit = math.sqrt(4.0 * max(0.0, 30.0 - x))
        v, x = (
            max(0.0, MODEL.decay * v + MODEL.speed_per_force * pid.control(v, 38.0 - x, limit)),
            x + DT * v,
        )
    assert v < 1e-3
    assert 29.0 < x < 30.2


def test_windup_costs_nothing():
    """A force limit far too weak for the reference's slope: no overshoot when it is reached."""
    reference = ReferenceParameters(acceleration=5.0, jerk=50.0)
    pid = TunedPid(TunedPidParameters(reference=reference, force_limit=900.0))
    _, speeds, _ = drive(pid, 0.0, 40.0)
    assert speeds.max() < 1.02 * 4.0
    assert speeds[-1] == pytest.approx(4.0, abs=1e-3)


def test_a_vehicle_weaker_than_its_model_does_not_wind_it_up():
    """The true mass is three times the known one: the rate limit cuts off most of the demand."""
    _, speeds, _ = drive(TunedPid(), 0.0, 40.0, mass=3000.0)
    assert speeds.max() < 1.1 * 4.0
    assert speeds[-1] == pytest.approx(4.0, abs=1e-3)


@given(speed=st.floats(0.5, 8.0), force=st.floats(-7000.0, 5000.0))
@settings(max_examples=100)
def test_it_takes_over_without_a_bump(speed, force):
    """After another acted its force goes on from there, no faster than the reference's jerk."""
    pid, p = TunedPid(), ReferenceParameters()
    pid.track(speed, math.inf, force=force)
    a = (force - MODEL.friction * speed) / MODEL.mass
    build_up = p.deceleration / p.jerk  # [s]
    sharpest = MODEL.mass * max(p.jerk, abs(a) / build_up) * DT
    assert abs(pid.control(speed, math.inf) - force) <= min(sharpest, 1000.0) + 1e-6


def test_at_the_reference_speed_it_takes_over_with_equal_force():
    pid = TunedPid()
    pid.track(4.0, math.inf, force=400.0)
    assert pid.control(4.0, math.inf) == 400.0


def test_what_another_applied_is_where_it_goes_on():
    """The safety layer brakes for 0.2 s: no kick, and back to the reference without overshoot."""
    pid, v, speeds, forces = TunedPid(), 4.0, [], []
    for k in range(300):
        u = pid.control(v, math.inf)
        if 100 <= k < 104:
            u = -8000.0
            pid.applied(u)
        v = max(0.0, MODEL.decay * v + MODEL.speed_per_force * u)
        speeds.append(v)
        forces.append(u)
    assert max(speeds) < 4.0 + 0.01
    assert np.diff(forces[104:]).max() <= 1000.0 + 1e-9
    assert speeds[-1] == pytest.approx(4.0, abs=1e-4)


def test_reset_forgets_all():
    pid = TunedPid()
    first = [pid.control(speed, 12.0) for speed in (3.0, 2.0, 4.0)]
    pid.reset()
    assert [pid.control(speed, 12.0) for speed in (3.0, 2.0, 4.0)] == first


@pytest.mark.parametrize("mass", [700.0, 1500.0, 12_000.0])
def test_the_gains_scale_with_the_plant(mass):
    """Its closed loop's poles are where bandwidth and damping say, whatever it drives."""
    p, model = TunedPidParameters(), replace(MODEL, mass=mass)
    K_p, K_i = p.gains(model)
    poles = np.roots([mass, model.friction + K_p, K_i])
    assert np.abs(poles) == pytest.approx(p.bandwidth)
    assert -poles.real == pytest.approx(p.damping * p.bandwidth)


def test_without_acceleration_feed_forward_it_lags_but_arrives():
    """The ablation: the feedback alone accelerates, with a greater error on the way."""

    def worst(feed_forward):
        pid, error = TunedPid(TunedPidParameters(acceleration_feed_forward=feed_forward)), 0.0
        v = 0.0
        for _ in range(300):
            u = pid.control(v, math.inf)
            v = MODEL.decay * v + MODEL.speed_per_force * u
            error = max(error, abs(pid.reference.speed - v))
        assert v == pytest.approx(4.0, abs=1e-2)
        return error

    assert worst(feed_forward=True) < 0.01 < 0.2 < worst(feed_forward=False)


def test_the_controller_calls_it_as_the_papers():
    decision = SpeedController(None, TunedPid()).control(Observation(0.0, 4.0, math.inf, EMPTY))
    assert (decision.acting, decision.reason, decision.plan) == ("pid", "selected", None)
    assert decision.force == pytest.approx(400.0)
    assert decision.reference_speed == 4.0


@pytest.mark.parametrize(("speed", "gap"), [(math.nan, 10.0), (4.0, math.nan), (math.inf, 10.0)])
def test_refuses_what_is_no_number(speed, gap):
    with pytest.raises(ParameterError, match=r"speed = .* m/s, gap = .* m: expected numbers"):
        TunedPid().control(speed, gap)


@pytest.mark.parametrize("name", ["bandwidth", "damping", "force_limit", "force_rate_limit"])
def test_refuses_senseless_parameters(name):
    with pytest.raises(ParameterError, match=f"{name} = -1.0: expected a finite number > 0"):
        TunedPidParameters(**{name: -1.0})
