"""The model descriptions of the zoo's cars: FMI 1.0, 2.0 and 3.0."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree as Xml

from support.fmus.cars import (
    CLOCK,
    INPUT_ARRAY,
    LOAD,
    OUTPUT_ARRAY,
    REFERENCES,
    input_elements,
)
from support.fmus.variables import (
    add_typed,
    add_unit_definitions,
    indicators,
    names_of,
    part,
    rates_of,
    set_attributes,
    states_of,
    units_of,
)

if TYPE_CHECKING:
    from support.fmus.cars import Car

IDENTIFIER: Final = "car"


def describe(car: Car, token: str) -> bytes:
    """The text of modelDescription.xml."""
    root = {"1.0": _fmi1, "2.0": _fmi2, "3.0": _fmi3}[car.fmi](car, token)
    Xml.indent(root)
    text: bytes = Xml.tostring(root, encoding="UTF-8", xml_declaration=True)
    return text


def _fmi1(car: Car, token: str) -> Xml.Element:
    root = Xml.Element(
        "fmiModelDescription",
        fmiVersion="1.0",
        modelName="Car",
        modelIdentifier=IDENTIFIER,
        guid=token,
        generationTool="the FMU zoo",
        variableNamingConvention="structured",
        numberOfContinuousStates="0",
        numberOfEventIndicators="0",
    )
    units = Xml.SubElement(root, "UnitDefinitions")
    for name in units_of(car):
        Xml.SubElement(units, "BaseUnit", unit=name)
    _default_experiment(root, car, startTime="0", stopTime="10")
    variables = Xml.SubElement(root, "ModelVariables")
    for quantity in (*car.inputs, *car.outputs, *car.parameters):
        causality, variability = part(car, quantity)
        element = Xml.SubElement(
            variables,
            "ScalarVariable",
            name=car.name(quantity),
            valueReference=str(REFERENCES[quantity]),
            causality="internal" if causality == "parameter" else causality,
            variability="parameter" if causality == "parameter" else variability,
        )
        add_typed(element, car, quantity)
    load = Xml.SubElement(
        variables,
        "ScalarVariable",
        name=car.name("load"),
        valueReference=str(LOAD),
        causality="internal",
        variability="parameter",
    )
    Xml.SubElement(load, "String", start="empty")
    implementation = Xml.SubElement(root, "Implementation")
    standalone = Xml.SubElement(implementation, "CoSimulation_StandAlone")
    Xml.SubElement(standalone, "Capabilities", _flags(car, "CoSimulation"))
    return root


def _fmi2(car: Car, token: str) -> Xml.Element:
    root = Xml.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName="Car",
        guid=token,
        generationTool="the FMU zoo",
        variableNamingConvention="structured",
        numberOfEventIndicators=str(indicators(car)),
    )
    for interface in car.interfaces:
        Xml.SubElement(root, interface, _flags(car, interface))
    add_unit_definitions(root, car)
    _default_experiment(root, car, startTime="0", stopTime="10")
    variables = Xml.SubElement(root, "ModelVariables")
    index = {}
    for quantity in names_of(car):
        causality, variability = part(car, quantity)
        index[quantity] = len(variables) + 1
        element = Xml.SubElement(
            variables,
            "ScalarVariable",
            name=car.name(quantity),
            valueReference=str(REFERENCES[quantity]),
            causality=causality,
            variability=variability,
        )
        if causality in ("output", "local"):
            element.set("initial", "calculated")
        typed = add_typed(element, car, quantity)
        if quantity.startswith("rate_"):
            typed.set("derivative", str(index[f"state_{quantity.removeprefix('rate_')}"]))
    load = Xml.SubElement(
        variables,
        "ScalarVariable",
        name=car.name("load"),
        valueReference=str(LOAD),
        causality="parameter",
        variability="fixed",
    )
    Xml.SubElement(load, "String", start="empty")
    structure = Xml.SubElement(root, "ModelStructure")
    states, rates = states_of(car), rates_of(car)
    for element_name, quantities in (
        ("Outputs", car.outputs),
        ("Derivatives", rates),
        ("InitialUnknowns", (*car.outputs, *states, *rates)),
    ):
        if quantities:
            unknowns = Xml.SubElement(structure, element_name)
            for number in sorted(index[quantity] for quantity in quantities):
                Xml.SubElement(unknowns, "Unknown", index=str(number))
    return root


def _fmi3(car: Car, token: str) -> Xml.Element:
    root = Xml.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName="Car",
        instantiationToken=token,
        generationTool="the FMU zoo",
        variableNamingConvention="structured",
    )
    for interface in car.interfaces:
        Xml.SubElement(root, interface, _flags(car, interface))
    add_unit_definitions(root, car)
    _default_experiment(root, car, startTime="0", stopTime="10")
    variables = Xml.SubElement(root, "ModelVariables")
    Xml.SubElement(
        variables,
        "Float64",
        name="time",
        valueReference="63",
        causality="independent",
        variability="continuous",
    )
    if car.clock:
        clock = {"name": "tick", "valueReference": str(CLOCK), "causality": "input"}
        Xml.SubElement(variables, "Clock", clock | dict(car.clock))
    if car.array:
        _arrays(variables, car)
    for quantity in names_of(car):
        causality, variability = part(car, quantity)
        if car.array and causality in ("input", "output"):
            continue
        element = Xml.SubElement(
            variables,
            car.kind_of(quantity),
            name=car.name(quantity),
            valueReference=str(REFERENCES[quantity]),
            causality=causality,
            variability=variability,
        )
        if causality in ("output", "local"):
            element.set("initial", "calculated")
        set_attributes(element, car, quantity)
        if quantity == "force" and car.clocked:
            element.set("clocks", str(CLOCK))
        if quantity.startswith("rate_"):
            element.set("derivative", str(REFERENCES[f"state_{quantity.removeprefix('rate_')}"]))
    load = Xml.SubElement(
        variables,
        "String",
        name=car.name("load"),
        valueReference=str(LOAD),
        causality="parameter",
        variability="fixed",
    )
    Xml.SubElement(load, "Start", value="empty")
    _fmi3_structure(root, car)
    return root


def _fmi3_structure(root: Xml.Element, car: Car) -> None:
    structure = Xml.SubElement(root, "ModelStructure")
    references = [REFERENCES[quantity] for quantity in car.outputs]
    outputs = [OUTPUT_ARRAY] if car.array else references
    rates = [REFERENCES[quantity] for quantity in rates_of(car)]
    states = [REFERENCES[quantity] for quantity in states_of(car)]
    for name, numbers in (
        ("Output", outputs),
        ("ContinuousStateDerivative", rates),
        ("InitialUnknown", [*outputs, *states, *rates]),
        ("EventIndicator", [REFERENCES["indicator"]] * indicators(car)),
    ):
        for number in numbers:
            Xml.SubElement(structure, name, valueReference=str(number))


def _arrays(variables: Xml.Element, car: Car) -> None:
    """The array of inputs ``u`` and the array of outputs ``y``."""
    real = "Float32" if car.float32 else "Float64"
    elements = input_elements(car)
    if car.array == "structural":
        Xml.SubElement(
            variables,
            "UInt64",
            name=car.name("array_size"),
            valueReference=str(REFERENCES["array_size"]),
            causality="structuralParameter",
            variability="fixed",
            start=str(len(elements)),
        )
    for name, reference, quantities, causality in (
        ("u", INPUT_ARRAY, elements, "input"),
        ("y", OUTPUT_ARRAY, car.outputs, "output"),
    ):
        element = Xml.SubElement(
            variables,
            real,
            name=name,
            valueReference=str(reference),
            causality=causality,
            variability="continuous",
        )
        if causality == "input":
            element.set("start", " ".join("0" for _ in quantities))
        units = {car.unit(quantity) for quantity in quantities}
        if len(units) == 1 and (unit := units.pop()) is not None:
            element.set("unit", unit[0])
        dimension = Xml.SubElement(element, "Dimension")
        if causality == "input" and car.array == "structural":
            dimension.set("valueReference", str(REFERENCES["array_size"]))
        else:
            dimension.set("start", str(len(quantities)))


# ---- what the versions have in common ----


def _flags(car: Car, interface: str) -> dict[str, str]:
    whole = car.only_step is None and not car.constant_step
    if car.fmi == "1.0":
        flags = {
            "canHandleVariableCommunicationStepSize": str(whole).lower(),
            "canBeInstantiatedOnlyOncePerProcess": str(car.once_per_process).lower(),
        }
        return flags | dict(car.flags)
    flags = {
        "modelIdentifier": IDENTIFIER,
        "canGetAndSetFMUState" if car.fmi == "3.0" else "canGetAndSetFMUstate": "true",
    }
    if car.once_per_process:
        flags["canBeInstantiatedOnlyOncePerProcess"] = "true"
    if interface == "CoSimulation":
        flags["canHandleVariableCommunicationStepSize"] = str(whole).lower()
        if car.fmi == "3.0" and car.only_step:
            flags["fixedInternalStepSize"] = repr(car.only_step)
    elif car.fmi == "3.0":
        flags["needsCompletedIntegratorStep"] = "true"
    return flags | dict(car.flags)


def _default_experiment(root: Xml.Element, car: Car, **attributes: str) -> None:
    if car.fmi != "1.0" and (step := car.only_step or car.step):
        attributes["stepSize"] = repr(step)
    Xml.SubElement(root, "DefaultExperiment", attributes)
