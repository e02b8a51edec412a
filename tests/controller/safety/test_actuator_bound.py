"""The bound of the force that acts, in steps."""

import pytest

from controller import Actuator, ActuatorSide
from controller.safety.actuator_bound import Lagging, bound_step

DT = 0.05  # [s]


@pytest.mark.parametrize("command", [3000.0, 0.0, -8000.0])
def test_without_a_lag_each_force_acts_as_it_is(command):
    driven, braked, ends, state = bound_step(command, (500.0, 500.0, 0.0), Lagging())
    assert driven - braked == command
    assert ends == (command, command)
    assert state[0] == command


def test_driving_ends_and_braking_begins_late_but_not_the_reverse():
    lag = ActuatorSide(lag=0.5)
    c = Lagging.of(Actuator(lag, lag), DT)
    driven, braked, _, state = bound_step(-8000.0, (2000.0, 2000.0, 0.0), c)
    assert 1800.0 < driven < 2000.0
    assert 0.0 < braked < 800.0
    driven, braked, _, _ = bound_step(3000.0, state, c)
    assert (driven, braked) == (3000.0, 0.0)


def test_a_rate_lets_the_force_fall_step_by_step():
    c = Lagging.of(Actuator(brake=ActuatorSide(rate=10000.0)), DT)
    state = (1000.0, 1000.0, 0.0)
    forces = []
    for _ in range(4):
        driven, braked, _, state = bound_step(-8000.0, state, c)
        forces.append(driven - braked)
    assert forces == [1000.0, 500.0, 0.0, -500.0]
