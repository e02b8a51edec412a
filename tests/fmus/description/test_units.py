"""Units by their names, and the FMU's own definitions before them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fmus.description import units
from fmus.description.model import Unit
from fmus.description.units import named, quantity, to_si


@pytest.mark.parametrize(
    ("names", "dimension", "factor"),
    [
        ("m/s m.s-1 m*s^-1 m/s^1 (m/s) m·s⁻¹ m/sec [m/s] M/S", units.SPEED, 1.0),
        ("km/h km.h-1 km/hr kmh kph kmph KM/H Km/h", units.SPEED, 1000 / 3600),
        ("mph mi/h MPH mile/hour", units.SPEED, 0.44704),
        ("kn kt knot knots nmi/h", units.SPEED, 1852 / 3600),
        ("ft/s fps", units.SPEED, 0.3048),
        ("cm/s", units.SPEED, 0.01),
        ("N kg.m/s2 kg.m.s-2 newton", units.FORCE, 1.0),
        ("kN", units.FORCE, 1000.0),
        ("daN", units.FORCE, 10.0),
        ("lbf", units.FORCE, 4.4482216152605),
        ("kgf kp", units.FORCE, 9.80665),
        ("kg", units.MASS, 1.0),
        ("g", units.MASS, 0.001),
        ("t Mg", units.MASS, 1000.0),
        ("lb lbs", units.MASS, 0.45359237),
        ("m metre meters", units.LENGTH, 1.0),
        ("km", units.LENGTH, 1000.0),
        ("mi mile", units.LENGTH, 1609.344),
        ("ft", units.LENGTH, 0.3048),
        ("mm", units.LENGTH, 1 / 1000),
        ("m/s2 m/s^2 m/s**2 m.s-2 m/s/s m/(s^2) m/s² m.s(-2)", units.ACCELERATION, 1.0),
        ("g0 g_n gee", units.ACCELERATION, 9.80665),
        ("rad", units.ANGLE, 1.0),
        ("deg °", units.ANGLE, math.pi / 180),
        ("rad/s", units.TURNING, 1.0),
        ("rpm rev/min", units.TURNING, 2 * math.pi / 60),
        ("1 - none", units.NONE, 1.0),
        ("% percent", units.NONE, 0.01),
        ("s sec", units.TIME, 1.0),
        ("ms", units.TIME, 0.001),
        ("min", units.TIME, 60.0),
        ("N.m Nm N*m", units.TORQUE, 1.0),
        ("kW", units.POWER, 1000.0),
        ("N.s/m N/(m/s) kg/s Ns/m", units.FRICTION, 1.0),
        ("N/(km/h)", units.FRICTION, 3.6),
    ],
)
def test_names(names, dimension, factor):
    for name in names.split():
        unit = named(name)
        assert (name, unit.dimension) == (name, dimension)
        assert unit.factor == pytest.approx(factor, rel=1e-15)
        assert unit.offset == 0.0


def test_spaces_multiply():
    assert named("m s-1").dimension == units.SPEED
    assert named(" kg m s^-2 ").dimension == units.FORCE


def test_a_temperature_has_an_offset():
    assert (named("degC").factor, named("degC").offset) == (1.0, 273.15)
    boiling = named("degF").factor * 212 + named("degF").offset
    assert boiling == pytest.approx(373.15)


@pytest.mark.parametrize(
    "name",
    ["", " ", "bananas", "K/h m", "m/", "/s", "m//s", "(m", "m)", "m^", "m/s22", "KN/x", "1e3"],
)
def test_a_name_that_nobody_knows_has_no_dimension(name):
    unit = named(name)
    assert unit.dimension is None or quantity(unit.dimension) not in {"a speed", "a force"}


def test_capitals_matter():
    assert named("kn").dimension == units.SPEED
    assert named("kN").dimension == units.FORCE
    assert named("Mg").factor == 1e3
    assert named("mg").factor == pytest.approx(1e-6)
    assert named("KN").dimension is None


def test_a_mass_is_no_force():
    assert named("kg").dimension != units.FORCE
    assert quantity(named("kg").dimension) == "a mass"
    assert quantity(named("kgf").dimension) == "a force"


def test_what_the_fmu_defines_comes_first():
    furlongs = Unit("m/s", 201.168 / 1209600, 0.0, units.SPEED)  # whatever it calls them
    assert to_si(furlongs) is furlongs


def test_an_empty_definition_is_none():
    """Some tools write <BaseUnit/> for every unit."""
    assert to_si(Unit("km/h", 1.0, 0.0, units.NONE)) == named("km/h")
    assert to_si(Unit("bananas", 1.0, 0.0, units.NONE)).dimension == units.NONE
    half = Unit("m", 0.5, 0.0, units.NONE)
    assert to_si(half) is half


def test_quantities_without_a_name_are_spelled_out():
    assert quantity(named("kg.m2").dimension) == "a quantity in kg.m2"
    assert quantity(None) == "unknown"


SIMPLE = st.sampled_from(["m", "s", "kg", "N", "km", "h", "rad", "kW", "lbf"])


@given(SIMPLE, SIMPLE, st.sampled_from([(".", 1), ("/", -1), ("*", 1)]))
def test_products_and_quotients_are_those_of_their_parts(one, other, operation):
    sign, power = operation
    product, a, b = named(f"{one}{sign}{other}"), named(one), named(other)
    assert product.dimension == tuple(
        x + power * y for x, y in zip(a.dimension, b.dimension, strict=True)
    )
    assert product.factor == pytest.approx(a.factor * b.factor**power, rel=1e-15)


@given(SIMPLE, st.integers(-9, 9).filter(bool))
def test_powers(name, power):
    unit = named(f"{name}^{power}")
    assert unit.dimension == tuple(power * x for x in named(name).dimension)
    assert unit.factor == pytest.approx(named(name).factor ** power, rel=1e-14)


@given(st.text(max_size=80))
def test_any_text_has_an_answer(text):
    unit = named(text)
    assert unit.name == text
    assert math.isfinite(unit.factor)
    assert unit.factor > 0


@pytest.mark.parametrize(
    ("product", "unit"),
    [("V.A", "W"), ("A.s/s", "A"), ("J/s", "W"), ("N.m", "J"), ("N/m2", "Pa"), ("1/s", "Hz")],
)
def test_derived_units_are_what_they_are_derived_from(product, unit):
    assert named(product) == Unit(product, 1.0, 0.0, named(unit).dimension)


def test_a_current_is_a_base_quantity():
    assert named("A").dimension == (0, 0, 0, 1, 0, 0, 0, 0)
