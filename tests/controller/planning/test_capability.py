"""Manoeuvres of a vehicle whose forces are limited and late."""

import pytest

from controller import Actuator, ActuatorSide, PlannerParameters
from controller.planning.capability import jerks_of, within

MASS = 1000.0  # [kg]


def test_no_manoeuvre_brakes_harder_than_the_brake():
    p = within(PlannerParameters(), Actuator(brake=ActuatorSide(lag=0.3, limit=4000.0)), MASS)
    assert p.force_limit == 4000.0
    assert min(p.manoeuvres.accelerations) == -4.0
    assert p.manoeuvres.deceleration == pytest.approx(3.2)
    assert p.manoeuvres.headway == pytest.approx(PlannerParameters().manoeuvres.headway + 0.3)


def test_an_ideal_actuator_changes_nothing():
    assert within(PlannerParameters(), Actuator(), MASS) == PlannerParameters()
    assert jerks_of(Actuator(), 8.0, MASS) == (8.0, 8.0)


def test_accelerations_rise_as_the_lagging_drive_can():
    actuator = Actuator(ActuatorSide(lag=0.8, limit=2500.0), ActuatorSide(rate=6000.0))
    falls, rises = jerks_of(actuator, 8.0, MASS)
    assert falls == 6.0
    assert rises == pytest.approx(0.64 * 2.5 / 0.8)
