"""People who want to be driven into, against an ego that wants to drive, step after step.

The ego moves as its model says or better, the people as the crowd does: x += v dt + a/2 dt^2 and
v += a dt, |a| <= a_max, |v| <= v_max. Looked at in between too, the moving front never gets into
anybody, and once a stop is possible it stays possible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from late_plants import LatePlant, actuators, late, weak

from controller import Actuator, LateSpeed, LongitudinalModel, SafetyLayer, SafetyParameters
from controller.safety.worst_motion import RECORDED

A_MAX, V_MAX, R, HALF = 5.0, 2.5, 0.27, 1.0
SIMULATED = {"walking_acceleration": A_MAX, "walking_speed": V_MAX}
LOOKS = 5  # in between, at each step
SPACING = 0.1  # m

relaxed = settings(max_examples=40)
seeds = st.integers(0, 2**32 - 1)


@dataclass(frozen=True)
class Road:
    """Straight on, or round to the left with this radius; heading east at the start."""

    radius: float = math.inf

    def pose(self, travel):
        if math.isinf(self.radius):
            return travel, 0.0, 1.0, 0.0
        angle = travel / self.radius
        cos, sin = math.cos(angle), math.sin(angle)
        return self.radius * sin, self.radius * (1.0 - cos), cos, sin

    def ahead(self, travel, reach):
        count = 1 if math.isinf(self.radius) else 2 + int(reach / SPACING)
        return np.array([self.pose(travel + SPACING * i) for i in range(count)])

    def local(self, travel, x):
        """Along and across of (n, 2) points from the front's middle."""
        x_0, y_0, cos, sin = self.pose(travel)
        d = x - (x_0, y_0)
        return d[:, 0] * cos + d[:, 1] * sin, d[:, 1] * cos - d[:, 0] * sin


class Plant:
    """The ego: by forward Euler or exactly, and obeying late."""

    def __init__(self, speed, *, dt=0.05, exact=False, delay=0):
        self.travel, self.speed, self.dt, self.exact = 0.0, speed, dt, exact
        self._late = [0.0] * delay

    def step(self, told):
        self._late.append(told)
        u, v, dt, z = self._late.pop(0), self.speed, self.dt, 0.1 * self.dt
        if not self.exact:
            self.travel += v * dt
            self.speed = max(0.0, v + dt * (u - 100.0 * v) / 1000.0)
            return
        end = u / 100.0
        after = end + (v - end) * math.exp(-z)
        if after >= 0.0:
            self.travel += end * dt + (v - end) * (1.0 - math.exp(-z)) / 0.1
            self.speed = after
        else:
            stops = math.log((v - end) / -end) / 0.1
            self.travel += end * stops + (v - end) * (1.0 - math.exp(-0.1 * stops)) / 0.1
            self.speed = 0.0


def walk(x, v, a, dt, hardest=A_MAX):
    """One step of the crowd with its limits (pedestrian_model): positions, velocities, (a)."""
    size = np.maximum(np.hypot(*a.T), 1e-12)[:, None]
    after = v + dt * a * np.minimum(1.0, np.reshape(hardest, (-1, 1)) / size)
    fast = np.maximum(np.hypot(*after.T), 1e-12)[:, None]
    after *= np.minimum(1.0, V_MAX / fast)
    return x + 0.5 * dt * (v + after), after


def wanting_to_be_hit(rng, n, road):
    """(n, 2) places about the front, and walks."""
    x_0, y_0, cos, sin = road.pose(rng.uniform(0.0, 8.0))
    x = np.column_stack([rng.uniform(-2.0, 6.0, n), rng.uniform(-4.0, 4.0, n)])
    x = x @ np.array([[cos, sin], [-sin, cos]]) + (x_0, y_0)
    pace, angle = rng.uniform(0.0, V_MAX, n), rng.uniform(-np.pi, np.pi, n)
    return x, np.column_stack([pace * np.cos(angle), pace * np.sin(angle)])


def accelerations(rng, mood, x, v, road, plant):
    """As hard as they can: at the front where it will be, or in any direction; some wait first."""
    look = rng.choice([0.1, 0.3, 0.6])
    x_0, y_0, cos, sin = road.pose(plant.travel + look * plant.speed)
    side = np.clip(road.local(plant.travel, x)[1], -HALF, HALF)
    front = np.column_stack([x_0 - side * sin, y_0 + side * cos])
    at_it = front - x - look * v
    angle = rng.uniform(-np.pi, np.pi, len(x))
    random = np.column_stack([np.cos(angle), np.sin(angle)])
    wanted = np.where((mood == 0)[:, None], random, at_it)
    waiting = (mood == 2) & (np.hypot(*at_it.T) > 2.0)
    size = np.maximum(np.hypot(*wanted.T), 1e-9)[:, None]
    return np.where(waiting[:, None], -v, A_MAX * wanted / size)


def moved_into(road, before, after, x, x_next, v, dt):
    """Whether the front got into a body within the step, at any of some looks."""
    along, across = road.local(before, x)
    if not ((np.abs(along) < 2.0) & (np.abs(across) < 2.5)).any():
        return False  # nobody is near
    a = 2.0 * (x_next - x - dt * v) / dt**2
    for t in np.linspace(0.0, dt, LOOKS + 1):
        travel = before + (after - before) * t / dt
        along, across = road.local(travel, x + t * v + 0.5 * t**2 * a)
        off = np.hypot(along, np.maximum(np.abs(across) - HALF, 0.0))
        if ((along >= 0.0) & (off < R)).any():
            return True
    return False


def drive(
    seed,
    *,
    road=Road(),
    people=4,
    steps=50,
    dt=0.05,
    noise=0.0,
    plant=None,
    hardest=A_MAX,
    kept=slice(None),
    command=float,
    seen_late=None,
    **parameters,
):
    """The reasons given while the ego drove; fails where its front got into one of ``kept``.

    ``hardest`` is how hard everybody, or each, accelerates at most, and ``command`` what is sent
    to the plant for the layer's force; ``seen_late`` knows how the plant's speed output lags.
    """
    rng = np.random.default_rng(seed)
    limits = SafetyParameters(position_error=noise, **(SIMULATED | parameters))
    layer = SafetyLayer(LongitudinalModel(time_step=dt), limits)
    plant = plant or Plant(0.0, dt=dt, exact=bool(rng.integers(2)))
    x, v = wanting_to_be_hit(rng, people, road)
    mood = rng.integers(3, size=people)
    reasons = []
    for _ in range(steps):
        eager = rng.choice([8000.0, 8000.0, 3000.0, rng.uniform(-8000.0, 8000.0)])
        angle = rng.uniform(-np.pi, np.pi, people)
        seen = x + noise * np.column_stack([np.cos(angle), np.sin(angle)])
        speed = plant.speed if seen_late is None else most_speed(seen_late, plant, layer)
        way = road.ahead(plant.travel, layer.reach(speed))
        safe = layer.filter(eager, speed, (way, SPACING), seen, v)
        reasons.append(safe.reason)
        a = accelerations(rng, mood, x, v, road, plant)
        before, moving = plant.travel, plant.speed
        plant.step(command(safe.force))
        if seen_late is not None:
            seen_late.applied(command(safe.force))
        x_next, v_next = walk(x, v, a, dt, hardest)
        if moving > 1e-9 or plant.travel > before:
            among = x[kept], x_next[kept], v[kept]
            assert not moved_into(road, before, plant.travel, *among, dt), safe
        x, v = x_next, v_next
    return reasons


def most_speed(seen_late, plant, layer):
    """The largest speed that the plant may have by its output, which the layer is told."""
    estimate = seen_late.look(plant.output)
    if not isinstance(seen_late, LateSpeed):
        return estimate
    assert seen_late.least - 1e-9 <= plant.speed <= seen_late.most + 1e-9
    layer.may_be_slower(seen_late.most - seen_late.least)
    return seen_late.most


@relaxed
@given(seed=seeds)
def test_its_front_gets_into_nobody_and_a_stop_stays_possible(seed):
    assert "unavoidable" not in drive(seed)


@relaxed
@given(seed=seeds, dt=st.sampled_from([0.01, 0.025, 0.1, 0.2]))
def test_at_other_steps_too(seed, dt):
    assert "unavoidable" not in drive(seed, dt=dt, steps=int(2.5 / dt))


@relaxed
@given(seed=seeds, radius=st.sampled_from([6.0, 12.0, -8.0]))
def test_in_a_bend_too(seed, radius):
    drive(seed, road=Road(radius))


@relaxed
@given(seed=seeds, noise=st.floats(0.02, 0.3))
def test_when_it_sees_them_wrongly_too(seed, noise):
    drive(seed, noise=noise)


@relaxed
@given(seed=seeds)
def test_when_its_own_braking_is_rate_limited_too(seed):
    assert "unavoidable" not in drive(seed, force_rate_limit=1000.0)


@relaxed
@given(seed=seeds, delay=st.integers(0, 4))
def test_when_the_vehicle_obeys_late_too(seed, delay):
    """It may be as late as is said, or sooner."""
    reasons = drive(seed, plant=Plant(0.0, delay=delay), actuator=late(0.2))
    assert "unavoidable" not in reasons


@settings(max_examples=25)
@given(seed=seeds, actuator=actuators, limit=st.sampled_from([np.inf, 4000.0]))
def test_with_any_actuator_within_what_its_profile_says(seed, actuator, limit):
    """Dead time, lag and rate of both sides may be as bad as is said, or better."""
    actuator = weak(actuator, limit)
    plant = LatePlant(0.0, actuator, seed)
    reasons = drive(seed, plant=plant, actuator=actuator, command=actuator.command)
    assert "unavoidable" not in reasons


@settings(max_examples=25)
@given(seed=seeds, actuator=actuators, lag=st.sampled_from([0.02, 0.2, 0.4]))
def test_when_its_speed_output_is_late_too(seed, actuator, lag):
    """The output may lag behind the motion by as much as is said, or less."""
    plant = LatePlant(0.0, actuator, seed, sensor=lag)
    seen_late = LateSpeed(LongitudinalModel(), lag, actuator, 8000.0)
    reasons = drive(
        seed, plant=plant, actuator=actuator, command=actuator.command, seen_late=seen_late
    )
    assert "unavoidable" not in reasons


def test_an_output_that_is_late_must_not_be_taken_for_the_speed():
    """With a filter of 0.4 s, an ego that brakes seems faster, and one that drives off slower."""

    class Believed:
        least = most = 0.0

        def look(self, output):
            return output

        def applied(self, force):
            pass

    def is_hit(seed):
        plant = LatePlant(0.0, Actuator(), seed, sensor=0.4)
        try:
            reasons = drive(seed, plant=plant, seen_late=Believed())
        except AssertionError:
            return True
        return "unavoidable" in reasons

    assert any(map(is_hit, range(20)))


@pytest.mark.parametrize("name", ["recorded-99.9", "responsible"])
@relaxed
@given(seed=seeds)
def test_within_the_assumptions_nobody_is_hit_and_a_stop_is_left(name, seed):
    """As hard as the assumption lets them, and no harder."""
    reasons = drive(seed, hardest=RECORDED[name].acceleration, **limits_of(name))
    assert "unavoidable" not in reasons


@pytest.mark.parametrize("name", ["recorded-99.9", "responsible"])
@relaxed
@given(seed=seeds)
def test_who_keeps_to_the_assumption_is_safe_whatever_others_do(name, seed):
    """The promise is made person by person: two of these four lunge as nobody is taken to."""
    bound = RECORDED[name].acceleration
    hardest = np.array([bound, bound, A_MAX, A_MAX])
    drive(seed, hardest=hardest, kept=slice(2), **limits_of(name))


def test_who_breaks_the_assumption_can_be_hit():
    """The bounds are no formality: beyond them the same adversaries reach the front."""

    def is_hit(seed):
        try:
            drive(seed, hardest=A_MAX, **limits_of("responsible"))
        except AssertionError:
            return True
        return False

    assert any(map(is_hit, range(200)))


def limits_of(name):
    worst = RECORDED[name]
    return {"walking_acceleration": worst.acceleration, "walking_speed": worst.speed}


@pytest.mark.parametrize("name", ["recorded-99.9", "responsible"])
def test_a_milder_assumption_lets_more_through(name):
    """Somebody stands 0.8 m beside the way of an ego at 4 m/s."""
    way, still = np.array([[0.0, 0.0, 1.0, 0.0]]), np.zeros((1, 2))
    beside = np.array([[0.8, 1.8]])

    def allowed(**limits):
        layer = SafetyLayer(LongitudinalModel(), SafetyParameters(**limits))
        return layer.filter(8000.0, 4.0, (way, SPACING), beside, still).force

    assert allowed(**limits_of(name)) > allowed(**SIMULATED) + 100.0


def test_these_people_are_driven_into_without_it():
    """The tests above are no formality: an ego that only drives gets into most of these crowds."""

    def is_hit(seed):
        rng = np.random.default_rng(seed)
        road, plant = Road(), Plant(0.0)
        x, v = wanting_to_be_hit(rng, 4, road)
        mood = rng.integers(3, size=4)
        for _ in range(50):
            a = accelerations(rng, mood, x, v, road, plant)
            before, moving = plant.travel, plant.speed
            plant.step(3000.0)
            x_next, v_next = walk(x, v, a, 0.05)
            if moving > 0.0 and moved_into(road, before, plant.travel, x, x_next, v, 0.05):
                return True
            x, v = x_next, v_next
        return False

    assert sum(map(is_hit, range(40))) > 20


@pytest.mark.parametrize("speed", [2.0, 4.0])
def test_a_sudden_step_before_the_ego_causes_full_braking(speed):
    layer = SafetyLayer(LongitudinalModel(), SafetyParameters())
    way, still = np.array([[0.0, 0.0, 1.0, 0.0]]), np.zeros((1, 2))
    safe = layer.filter(1000.0, speed, (way, SPACING), np.array([[0.4, 0.0]]), still)
    assert safe == (-8000.0, True, "unavoidable")
