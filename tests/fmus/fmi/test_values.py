"""FMI 1's negated aliases: SimulationX and Dymola write a reaction force as minus the force."""

from __future__ import annotations

import pytest

from fmus.description.reading import read_model
from fmus.profile.draft_profile import draft_profile


@pytest.fixture
def reversed_car(zoo, redescribed):
    """All numbers of a car are negated aliases of what stands under their references."""
    plain = zoo.car(fmi="1.0", units={"speed": ("km/h", 1 / 3.6, 0.0)})
    marked = redescribed(plain, "<ScalarVariable ", '<ScalarVariable alias="negatedAlias" ')
    return plain, marked


def flipped(profile):
    """A profile for the opposite signs: of the force, and of all that is read and set."""
    return {
        table: {role: axis | {"gain": -1.0} for role, axis in profile[table].items()}
        for table in ("inputs", "outputs", "initial")
    }


def drive(vehicle):
    """Started at 4 m/s, driven and braked."""
    vehicle.start(speed=4.0, position=7.0)
    motion = []
    for force in (1500.0,) * 10 + (-2500.0,) * 10:
        vehicle.step(force)
        motion.append((vehicle.position, vehicle.speed, vehicle.acceleration))
    return motion


def test_a_negated_alias_is_minus_the_other_variable(reversed_car, open_car, zoo):
    plain, marked = reversed_car
    profile = zoo.profile(plain)
    with open_car(plain) as one, open_car(marked, like=plain, **flipped(profile)) as other:
        assert drive(other) == drive(one)


def test_start_values_of_negated_aliases_are_negated_too(zoo, redescribed, open_car):
    heavy = zoo.car(fmi="1.0", values={"mass": 1500.0})
    turned = redescribed(heavy, 'name="mass"', 'name="mass" alias="negatedAlias"')
    with open_car(heavy) as one, open_car(turned, like=heavy, parameters={"mass": -1500.0}) as two:
        assert drive(two) == drive(one)


def test_a_negated_boolean_is_the_other_truth(zoo, redescribed, open_car):
    car = zoo.car(fmi="1.0", values={"engaged": 1.0})
    turned = redescribed(car, 'name="engaged"', 'name="engaged" alias="negatedAlias"')
    released = {"parameters": {"engaged": False}}
    with open_car(car) as one, open_car(turned, like=car, **released) as two:
        assert drive(two) == drive(one)


def test_a_model_description_tells_which_they_are(reversed_car):
    plain, marked = reversed_car
    assert not any(v.negated for v in read_model(plain).variables.values())
    assert all(v.negated for v in read_model(marked).variables.values())


def test_a_draft_asks_which_way_a_negated_alias_counts(reversed_car):
    plain, marked = reversed_car
    assert draft_profile(read_model(plain)).confident
    asked = draft_profile(read_model(marked))
    assert any("is minus another variable" in doubt for doubt in asked.doubts)
