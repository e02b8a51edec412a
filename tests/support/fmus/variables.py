"""The variables of the zoo's cars in their model descriptions: units, values, causality."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree as Xml

from support.fmus.cars import QUANTITIES

if TYPE_CHECKING:
    from support.fmus.cars import Car

BASE: Final = {  # unit: base units; one not listed has those of its quantity's own unit
    "N": "kg1 m1 s-2", "N/s": "kg1 m1 s-3", "m/s2": "m1 s-2", "m/s": "m1 s-1", "m": "m1", "s": "s1",
    "kg": "kg1", "N.s/m": "kg1 s-1", "N.s2/m2": "kg1 m-1", "1": "", "%": "",
    "rad": "rad1",
}  # fmt: skip


def rates_of(car: Car) -> tuple[str, ...]:
    return tuple(f"rate_{name}" for name in car.states) if "ModelExchange" in car.interfaces else ()


def states_of(car: Car) -> tuple[str, ...]:
    return tuple(rate.replace("rate_", "state_") for rate in rates_of(car))


def indicators(car: Car) -> int:
    return int("ModelExchange" in car.interfaces and car.value("holds") != 0.0)


def names_of(car: Car) -> tuple[str, ...]:
    indicator = ("indicator",) * (indicators(car) * (car.fmi == "3.0"))
    return (*car.inputs, *car.outputs, *car.parameters, *states_of(car), *rates_of(car), *indicator)


def part(car: Car, quantity: str) -> tuple[str, str]:
    """Causality and variability in the words of FMI 2 and 3."""
    continuous = car.kind_of(quantity) in ("Real", "Float64", "Float32")
    changing = "continuous" if continuous else "discrete"
    if quantity in car.inputs:
        return "input", changing
    if quantity in car.outputs:
        return "output", changing
    if quantity in car.parameters:
        return "parameter", "fixed"
    return "local", changing


def units_of(car: Car) -> dict[str, tuple[float, float, str]]:
    """Each declared unit: factor, offset and the SI unit it is of."""
    units = {}
    for quantity in names_of(car):
        unit = car.unit(quantity)
        if unit is not None and car.kind_of(quantity) in ("Real", "Float64", "Float32"):
            of = unit[0] if unit[0] in BASE else QUANTITIES[quantity]
            units[unit[0]] = (unit[1], unit[2], of)
    return units


def add_unit_definitions(root: Xml.Element, car: Car) -> None:
    units = units_of(car)
    if not units:
        return
    definitions = Xml.SubElement(root, "UnitDefinitions")
    for name, (factor, offset, of) in units.items():
        unit = Xml.SubElement(definitions, "Unit", name=name)
        if not car.define_units:
            continue
        base = Xml.SubElement(unit, "BaseUnit")
        for power in BASE[of].split():
            symbol = power.rstrip("-0123456789")
            base.set(symbol, power[len(symbol) :])
        if name not in ("kg",):
            base.set("factor", repr(factor))
            base.set("offset", repr(offset))


def add_typed(element: Xml.Element, car: Car, quantity: str) -> Xml.Element:
    typed = Xml.SubElement(element, car.kind_of(quantity))
    set_attributes(typed, car, quantity)
    return typed


def set_attributes(element: Xml.Element, car: Car, quantity: str) -> None:
    """Unit and start value."""
    kind = car.kind_of(quantity)
    real = kind in ("Real", "Float64", "Float32")
    unit = car.unit(quantity)
    if real and unit is not None:
        element.set("unit", unit[0])
    if part(car, quantity)[0] in ("input", "parameter"):
        raw = car.raw(quantity)
        boolean = "true" if raw else "false"
        text = repr(raw) if real else boolean if kind == "Boolean" else str(round(raw))
        element.set("start", text)
