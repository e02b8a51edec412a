"""The forces on their way through an actuator, against a simulation of it."""

import math

import pytest
from late_plants import FRICTION, MASS

from controller import Actuator, ActuatorSide, LongitudinalModel, ParameterError
from controller.actuator import Anticipation, lag_shares

MODEL = LongitudinalModel(MASS, FRICTION)
DT = MODEL.time_step


class Simulated:
    """A vehicle with two actuators, in the controller's steps."""

    def __init__(self, actuator, speed):
        self.actuator, self.speed, self.acts = actuator, speed, [0.0, 0.0]
        self.told = [0.0] * 20

    def step(self, command):
        self.told.append(command)
        mean = 0.0
        sides = self.actuator.drive, self.actuator.brake
        for i, (side, sign) in enumerate(zip(sides, (1.0, -1.0), strict=True)):
            wanted = sign * self.told[-1 - round(side.delay / DT)] / side.scale
            wanted = min(max(wanted, 0.0), side.largest(self.speed))
            end, share = lag_shares(side.lag, DT)
            mean += sign * (wanted + share * (self.acts[i] - wanted))
            self.acts[i] = wanted + end * (self.acts[i] - wanted)
        self.speed = max(0.0, MODEL.decay * self.speed + MODEL.speed_per_force * mean)
        return mean


ACTUATORS = [
    Actuator(ActuatorSide(lag=0.2, delay=0.25), ActuatorSide(lag=0.2, delay=0.25)),
    Actuator(ActuatorSide(scale=1.1, lag=0.8, limit=2500.0), ActuatorSide(0.9, 0.3, 0.3)),
    Actuator(ActuatorSide(delay=0.3, limit=4000.0, power_from=5.0), ActuatorSide(delay=0.1)),
]


@pytest.mark.parametrize("actuator", ACTUATORS)
def test_what_is_anticipated_comes_true_and_forces_act_as_wanted(actuator):
    anticipation, vehicle = Anticipation(MODEL, actuator), Simulated(actuator, 4.0)
    expected, wanted, means = [], [], []
    for k in range(80):
        ahead = anticipation.look(vehicle.speed)
        expected.append(ahead.speed)
        force = 1200.0 * math.sin(0.1 * k)
        force = min(max(force, ahead.least), ahead.most)
        wanted.append(force)
        means.append(vehicle.step(anticipation.command([force])))
        if k >= anticipation.steps:
            assert vehicle.speed > 0.0
    late = anticipation.steps
    speeds = [expected[k + 1] for k in range(len(expected) - 1)]
    assert len(speeds) == 79
    if actuator is ACTUATORS[1]:
        return  # the drive is cut where the slower brake has to be told before
    assert means[late:] == pytest.approx(wanted[: len(means) - late], abs=1e-6)


def test_another_part_s_force_is_anticipated_too():
    actuator = ACTUATORS[1]
    anticipation, vehicle = Anticipation(MODEL, actuator), Simulated(actuator, 8.0)
    anticipated = []
    for k in range(40):
        anticipated.append(anticipation.look(vehicle.speed).speed)
        command = anticipation.command([900.0])
        if 10 <= k < 20:
            command = -6000.0
            anticipation.applied(command)
        vehicle.step(command)
        if k >= 6:
            assert abs(vehicle.speed - (anticipated[k - 5])) < 0.5
    assert anticipation.look(vehicle.speed).travel > 0.0


def test_an_ideal_actuator_is_told_from_others():
    assert Actuator().ideal
    assert not any(actuator.ideal for actuator in ACTUATORS)
    assert Actuator().command(5.0) == Actuator().acting(5.0) == 5.0


@pytest.mark.parametrize(
    "wrong",
    [{"lag": -0.1}, {"delay": -0.1}, {"delay": 9.0}, {"limit": 0.0}, {"scale": 0.0}],
)
def test_a_value_out_of_range_is_refused(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        ActuatorSide(**wrong)
