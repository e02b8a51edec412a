"""What an FMU says about itself, in one form for FMI 1, 2 and 3."""

from __future__ import annotations

import pickle
import re

import pytest

from fmus import bundled_fmu
from fmus.description.model import Kind, Unit
from fmus.description.reading import describe, read_model
from fmus.fmi.validation import findings

STAND_ALONE = """<Implementation><CoSimulation_StandAlone>
 <Capabilities canHandleVariableCommunicationStepSize="true" maxOutputDerivativeOrder="2"
 canBeInstantiatedOnlyOncePerProcess="true"/></CoSimulation_StandAlone></Implementation>"""
TOOL = """<Implementation><CoSimulation_Tool><Capabilities/><Model entryPoint="x.slx"
 manualStart="true" type="application/x"/></CoSimulation_Tool></Implementation>"""


# ---- FMI 1 ----


def test_fmi1_co_simulation(fmu, fmi1_xml):
    model = read_model(fmu(fmi1_xml(STAND_ALONE)))
    assert (model.fmi_version, model.name, model.guid) == ("1.0", "Old car", "{1}")
    (interface,) = model.interfaces.values()
    assert (interface.kind, interface.identifier) == (Kind.CO_SIMULATION, "oldcar")
    assert interface.variable_step
    assert not interface.needs_execution_tool
    assert interface.flags["maxOutputDerivativeOrder"] == "2"
    assert model.default_tolerance == 1e-5


def test_fmi1_without_capabilities_can_do_little(fmu, fmi1_xml):
    (interface,) = read_model(fmu(fmi1_xml(TOOL))).interfaces.values()
    assert interface.needs_execution_tool
    assert not interface.variable_step
    assert not interface.saves_state


def test_fmi1_model_exchange(fmu, fmi1_xml):
    model = read_model(fmu(fmi1_xml("")))
    (interface,) = model.interfaces.values()
    assert (interface.kind, interface.completed_step_needed) == (Kind.MODEL_EXCHANGE, True)
    assert (model.states, model.event_indicators) == (2, 1)


def test_fmi1_variables_in_the_words_of_the_later_standards(fmu, fmi1_xml):
    variables = read_model(fmu(fmi1_xml(STAND_ALONE))).variables
    assert (variables["m"].causality, variables["m"].variability) == ("parameter", "fixed")
    assert (variables["v"].unit, variables["v"].minimum) == ("km/h", 0.0)
    assert variables["guess"].settable  # its start value is a first guess
    assert variables["guess"].settable
    assert not variables["v"].settable
    assert variables["back"].negated  # -v
    assert variables["back"].reference == variables["v"].reference
    assert not variables["v"].negated


# ---- FMI 2 ----


def test_fmi2_interfaces(fmi2):
    model = read_model(fmi2())
    assert list(model.interfaces) == [Kind.CO_SIMULATION, Kind.MODEL_EXCHANGE]
    cs, me = model.interfaces.values()
    assert (cs.identifier, me.identifier) == ("car_cs", "car_me")
    assert (cs.saves_state, me.saves_state) == (True, False)
    assert (cs.variable_step, me.variable_step) == (False, True)
    assert (cs.completed_step_needed, me.completed_step_needed) == (True, False)
    assert (cs.needs_execution_tool, me.needs_execution_tool) == (False, True)
    assert set(cs.flags) == {"canGetAndSetFMUstate", "canInterpolateInputs"}


def test_fmi2_model(fmi2):
    model = read_model(fmi2())
    assert (model.states, model.event_indicators) == (1, 3)
    assert (model.default_step, model.default_tolerance) == (0.01, 1e-4)
    assert model.generation_tool == "Modelling \N{GREEK SMALL LETTER ALPHA}"


def test_fmi2_variables(fmi2):
    variables = read_model(fmi2()).variables
    u, v, gear = variables["u"], variables["v"], variables["gear"]
    assert (u.reference, u.kind, u.causality, u.unit) == (10, "Real", "input", "N")
    assert (u.start, u.minimum, u.maximum, u.description) == ("0", -5.0, None, "wanted")
    assert (gear.kind, gear.variability) == ("Enumeration", "tunable")
    assert variables["label"].start == "a b"
    assert variables["der(v)"].causality == "local"
    settable = {name for name, variable in variables.items() if variable.settable}
    assert settable == {"u", "v", "gear", "on", "label"}
    assert (v.unit, v.minimum, v.maximum) == ("km/h", -10.0, 90.0)  # its own limit comes first


def test_units_as_the_fmu_defines_them(fmi2):
    units = read_model(fmi2()).units
    assert units["km/h"] == Unit("km/h", 0.2777777777777778, 0.0, (0, 1, -1, 0, 0, 0, 0, 0))
    assert units["degC"] == Unit("degC", 1.0, 273.15, (0, 0, 0, 0, 1, 0, 0, 0))
    assert units["thing"].dimension is None


@pytest.mark.parametrize("text", ["2.0", "2.0.4"])
def test_patch_versions_are_their_standard(fmi2, text):
    assert read_model(fmi2('fmiVersion="2.0"', f'fmiVersion="{text}"')).fmi_version == "2.0"


# ---- FMI 3 ----


def test_fmi3_interfaces(fmu, fmi3_xml):
    model = read_model(fmu(fmi3_xml()))
    cs, me = model.interfaces.values()
    assert (model.guid, cs.saves_state, cs.fixed_internal_step) == ("{3}", True, 0.01)
    assert me.completed_step_needed


def test_fmi3_arrays_are_as_long_as_structural_parameters_say(fmu, fmi3_xml):
    model = read_model(fmu(fmi3_xml()))
    x = model.variables["x"]
    assert (x.shape, x.size, x.scalar) == ((3, 2), 6, False)
    assert (model.states, model.event_indicators) == (6, 1)


def test_fmi3_types_defaults_and_aliases(fmu, fmi3_xml):
    variables = read_model(fmu(fmi3_xml())).variables
    v, speed, count = variables["v"], variables["speed"], variables["count"]
    assert (v.kind, v.unit, v.maximum) == ("Float32", "m/s", 50.0)
    assert (speed.name, speed.reference) == ("speed", v.reference)
    assert (v.variability, count.variability) == ("continuous", "discrete")
    assert variables["note"].start == "a & b"
    assert variables["note"].variability == "fixed"


# ---- what it is for ----


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_description_identifies_the_file(version):
    description = describe(str(bundled_fmu(version)))
    assert description.name == "LongitudinalVehicle"
    assert description.fmi_version == version
    assert re.fullmatch("[0-9a-f]{64}", description.sha256)


def test_a_model_can_be_handed_to_another_process(fmi2):
    model = read_model(fmi2())
    assert pickle.loads(pickle.dumps(model)) == model


def test_many_variables(fmu, fmi2_xml):
    one = '<ScalarVariable name="v{0}" valueReference="{0}"><Real start="1"/></ScalarVariable>'
    variables = "".join(one.format(n) for n in range(50_000))
    model = read_model(fmu(fmi2_xml(variables)))
    assert len(model.variables) == 50_000


def test_fmpys_findings_are_lines(fmi2):
    found = findings(fmi2('name="u"', 'name="u u"'))
    assert found
    assert all(line.isprintable() and len(line) <= 200 for line in found)
