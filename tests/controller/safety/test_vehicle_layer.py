"""The safety layer for vehicles: whatever the vehicle ahead and the controller do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from late_plants import LatePlant, actuators, late

from controller import LongitudinalModel, ParameterError, VehicleAhead, VehicleLayer, VehicleLimits
from controller.driving_constants import EMERGENCY_BRAKING, RESPONSE, RESTORING
from controller.kernels import needed_behind, safe_speed_behind

DT = 0.05  # [s]
MODEL = LongitudinalModel(time_step=DT)
LIMITS = VehicleLimits()
FULL = LIMITS.force_limit  # N
ROUNDING = 1e-6


def braking(speed: float, force: float) -> float:
    """The deceleration [m/s^2] that a force causes at a speed."""
    return -(force - MODEL.friction * speed) / MODEL.mass


class Drive:
    """An ego behind a vehicle that SUMO moves: steps of semi-implicit Euler, news once a step."""

    def __init__(self, gap: float, speed: float, its_speed: float, substeps: int, delay: int = 0):
        limits = VehicleLimits(actuator=late(delay * DT))
        self.layer = VehicleLayer(MODEL, limits)
        self.rear, self.its_speed, self.substeps = gap, its_speed, substeps
        self.front, self.speed, self.age, self.slows = 0.0, speed, 0, 0.0
        self.commands = [MODEL.friction * speed] * delay
        for command in self.commands:
            self.layer.applied(command)
        self.new, self.gaps, self.decelerations = True, [gap], list[float]()

    def ahead(self) -> VehicleAhead:
        """The vehicle ahead as the ego knows it."""
        age, step = self.age * DT, self.substeps * DT
        gap = self.rear + self.its_speed * age - self.front
        return VehicleAhead(gap, self.its_speed, EMERGENCY_BRAKING, self.slows, age, self.new, step)

    def step(self, force: float, acceleration: float) -> None:
        """One control step; SUMO's vehicle has a new speed at the end of SUMO's step."""
        safe = self.layer.filter(force, self.speed, self.ahead())
        assert safe <= force
        self.layer.applied(safe)
        self.commands.append(safe)
        acts = self.commands[-1 - (len(self.layer._memory[0]) - 1)]
        self.decelerations.append(braking(self.speed, acts))
        self.front += DT * self.speed
        self.speed = max(0.0, MODEL.decay * self.speed + MODEL.speed_per_force * acts)
        self.age, self.new = self.age + 1, False
        if self.age == self.substeps:
            before = self.its_speed
            self.its_speed = max(0.0, before + acceleration * self.substeps * DT)
            self.slows = max(0.0, before - self.its_speed) / (self.substeps * DT)
            self.rear += self.its_speed * self.substeps * DT
            self.age = 0
        self.gaps.append(self.rear + self.its_speed * self.age * DT - self.front)


accelerations = st.lists(
    st.one_of(st.just(-EMERGENCY_BRAKING), st.floats(-EMERGENCY_BRAKING, 2.6)),
    min_size=4,
    max_size=12,
)


@settings(max_examples=120)
@given(
    speed=st.floats(0.0, 30.0),
    its_speed=st.floats(0.0, 30.0),
    substeps=st.sampled_from([1, 2, 10, 20]),
    delay=st.sampled_from([0, 3]),
    accelerations=accelerations,
    forces=st.lists(st.floats(-FULL, FULL), min_size=1, max_size=7),
)
def test_no_vehicle_that_brakes_is_hit(speed, its_speed, substeps, delay, accelerations, forces):
    """From a safe gap, at steps of SUMO of 0.05 to 1 s, with a brake that follows at once or late.

    The adversary brakes in emergency or as it likes, and the controller asks for anything.
    """
    gap = 200.0
    drive = Drive(gap, speed, its_speed, substeps, delay)
    for i in range(len(accelerations) * 20):
        drive.step(forces[i % len(forces)], accelerations[i // 20])
    assert min(drive.gaps) >= LIMITS.margin - ROUNDING
    if min(forces) >= 0.0 and delay == 0:
        friction = MODEL.friction * speed / MODEL.mass
        assert max(drive.decelerations) <= max(RESPONSE, friction) * 1.001


@settings(max_examples=20)
@given(
    seed=st.integers(0, 2**32 - 1),
    actuator=actuators,
    substeps=st.sampled_from([1, 2, 10]),
    accelerations=accelerations,
    forces=st.lists(st.floats(-FULL, FULL), min_size=1, max_size=7),
)
def test_nor_with_any_actuator_within_its_profile(seed, actuator, substeps, accelerations, forces):
    drive = Drive(200.0, 0.0, 15.0, substeps)
    layer = VehicleLayer(MODEL, VehicleLimits(actuator=actuator))
    plant = LatePlant(0.0, actuator, seed)
    for i in range(len(accelerations) * 20):
        force = layer.filter(forces[i % len(forces)], plant.speed, drive.ahead())
        layer.applied(force)
        drive.step(0.0, accelerations[i // 20])  # moves the vehicle ahead
        plant.step(force)
        drive.front, drive.speed = plant.travel, plant.speed
        assert drive.rear + drive.its_speed * drive.age * DT - drive.front > LIMITS.margin - 0.001


@pytest.mark.parametrize("substeps", [1, 2, 10, 20])
@pytest.mark.parametrize("speed", [5.0, 14.0, 30.0])
def test_a_controller_that_never_brakes_stops_behind(substeps: int, speed: float) -> None:
    drive = Drive(250.0, speed, speed, substeps)
    for i in range(800):
        drive.step(FULL, 0.0 if i < 300 else -EMERGENCY_BRAKING)
    assert drive.speed == 0.0
    assert min(drive.gaps) >= LIMITS.margin - ROUNDING
    assert drive.gaps[-1] < LIMITS.margin + 1.0  # and it may drive up to it
    assert max(drive.decelerations) <= RESPONSE * 1.001


@pytest.mark.parametrize("substeps", [1, 10, 20])
def test_a_gap_that_a_vehicle_cuts_into_is_restored_gently(substeps: int) -> None:
    drive = Drive(6.0, 13.9, 14.0, substeps)
    for _ in range(500):
        drive.step(1500.0, 0.0)
    assert max(drive.decelerations) <= RESTORING + 0.01
    assert not drive.layer.restores
    assert drive.gaps[-1] > 10.0


def test_a_vehicle_that_cuts_in_and_brakes_is_braked_for() -> None:
    drive = Drive(10.0, 13.9, 14.0, 2)
    for i in range(300):
        drive.step(1500.0, 0.0 if i < 20 else -4.5)
    assert min(drive.gaps) > 0.0
    assert max(drive.decelerations) > 3.0


def test_a_vehicle_that_cuts_in_slowly_is_braked_for() -> None:
    drive = Drive(12.0, 13.9, 8.0, 2)
    for _ in range(300):
        drive.step(1500.0, 0.0)
    assert min(drive.gaps) > LIMITS.margin
    assert max(drive.decelerations) < 4.5


def test_without_a_vehicle_or_far_behind_nothing_is_changed() -> None:
    layer = VehicleLayer(MODEL, LIMITS)
    assert layer.filter(FULL, 13.9, None) == FULL
    assert layer.filter(FULL, 13.9, VehicleAhead(150.0, 13.9)) == FULL
    assert not layer.restores


def test_the_safe_distance_is_that_of_rss_for_small_steps() -> None:
    """Definition 1 of the paper: v^2/(2 b) of both, without a response time."""
    for v, its_speed in ((13.9, 13.9), (13.9, 5.0), (25.0, 20.0)):
        rss = v**2 / (2.0 * RESPONSE) - its_speed**2 / (2.0 * EMERGENCY_BRAKING)
        ahead = VehicleAhead(rss + 1.0, its_speed, step=0.001)
        assert safe_speed_behind(ahead, RESPONSE, 1.0, 0.0) == pytest.approx(v, rel=2e-3)


def test_old_news_ask_for_a_larger_gap() -> None:
    speeds = [
        safe_speed_behind(VehicleAhead(30.0, 13.9, step=step), RESPONSE, 1.0, 0.0)
        for step in (0.1, 0.5, 1.0)
    ]
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[0] > 18.0
    assert speeds[-1] < 14.0


def test_the_deceleration_that_is_needed_behind() -> None:
    assert needed_behind(10.0, VehicleAhead(5.0, 10.0), 1.0) == 0.0  # it does not close
    assert needed_behind(10.0, VehicleAhead(9.0, 6.0), 1.0) == pytest.approx(1.0)
    brakes = VehicleAhead(9.0, 10.0, decelerates=5.0)
    assert needed_behind(10.0, brakes, 1.0) == pytest.approx(100.0 / (2.0 * 18.0))


def test_the_past_is_forgotten() -> None:
    layer = VehicleLayer(MODEL, VehicleLimits(actuator=late(0.2)))
    layer.applied(FULL)
    layer.reset()
    assert not np.any(layer._memory[0])


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("response", -1.0),
        ("force_limit", -1.0),
        ("margin", -1.0),
    ],
)
def test_a_limit_out_of_range_is_refused(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=name):
        VehicleLimits(**{name: value})
