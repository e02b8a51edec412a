"""What an FMU says about itself, in one form for FMI 1, 2 and 3."""

from __future__ import annotations

import pickle
import re
import struct
import zipfile

import pytest

from fmus import bundled_fmu
from fmus.binaries import Platform, misfit, this_platform
from fmus.errors import FmuFileError, FmuInterfaceError, FmuPlatformError
from fmus.fmi.reading import binary_of, describe, findings, read_model
from fmus.model import Kind, Unit

FMI1 = """<fmiModelDescription fmiVersion="1.0" modelName="Old car" modelIdentifier="oldcar"
 guid="{1}" numberOfContinuousStates="2" numberOfEventIndicators="1">
 <UnitDefinitions><BaseUnit unit="rad"><DisplayUnitDefinition displayUnit="deg" gain="57.3"/>
 </BaseUnit></UnitDefinitions>
 <TypeDefinitions><Type name="Speed"><RealType unit="km/h" min="0"/></Type></TypeDefinitions>
 <DefaultExperiment startTime="0" tolerance="1e-5"/>
 <ModelVariables>
  <ScalarVariable name="F" valueReference="1" causality="input"><Real unit="N" start="0"/>
  </ScalarVariable>
  <ScalarVariable name="v" valueReference="2" causality="output"><Real declaredType="Speed"/>
  </ScalarVariable>
  <ScalarVariable name="m" valueReference="3" variability="parameter"><Real start="1e3"/>
  </ScalarVariable>
  <ScalarVariable name="guess" valueReference="4"><Real start="1" fixed="false"/></ScalarVariable>
  <ScalarVariable name="back" valueReference="2" causality="output" alias="negatedAlias"><Real/>
  </ScalarVariable>
 </ModelVariables>{implementation}
</fmiModelDescription>"""
STAND_ALONE = """<Implementation><CoSimulation_StandAlone>
 <Capabilities canHandleVariableCommunicationStepSize="true" maxOutputDerivativeOrder="2"
 canBeInstantiatedOnlyOncePerProcess="true"/></CoSimulation_StandAlone></Implementation>"""
TOOL = """<Implementation><CoSimulation_Tool><Capabilities/><Model entryPoint="x.slx"
 manualStart="true" type="application/x"/></CoSimulation_Tool></Implementation>"""

FMI2 = """<fmiModelDescription fmiVersion="2.0" modelName="Car" guid="{{2}}"
 generationTool="Modelling \N{GREEK SMALL LETTER ALPHA}" numberOfEventIndicators="3">
 <CoSimulation modelIdentifier="car_cs" canGetAndSetFMUstate="true" canInterpolateInputs="1"
  canBeInstantiatedOnlyOncePerProcess="false"/>
 <ModelExchange modelIdentifier="car_me" completedIntegratorStepNotNeeded="true"
  needsExecutionTool="true"/>
 <UnitDefinitions>
  <Unit name="km/h"><BaseUnit m="1" s="-1" factor="0.2777777777777778"/></Unit>
  <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  <Unit name="thing"/>
 </UnitDefinitions>
 <TypeDefinitions>
  <SimpleType name="Speed"><Real unit="km/h" min="-10" max="200"/></SimpleType>
  <SimpleType name="Gear"><Enumeration><Item name="P" value="1"/></Enumeration></SimpleType>
 </TypeDefinitions>
 <DefaultExperiment stepSize="0.01" tolerance="1e-4"/>
 <ModelVariables>{variables}</ModelVariables>
 <ModelStructure>{structure}</ModelStructure>
</fmiModelDescription>"""
VARIABLES2 = """
  <ScalarVariable name="u" valueReference="10" causality="input" description="wanted">
   <Real start="0" unit="N" min="-5"/></ScalarVariable>
  <ScalarVariable name="v" valueReference="11" causality="output" initial="exact">
   <Real declaredType="Speed" start="36" max="90"/></ScalarVariable>
  <ScalarVariable name="der(v)" valueReference="12"><Real derivative="2"/></ScalarVariable>
  <ScalarVariable name="gear" valueReference="0" causality="parameter" variability="tunable">
   <Enumeration declaredType="Gear" start="1"/></ScalarVariable>
  <ScalarVariable name="on" valueReference="0" causality="parameter" variability="fixed">
   <Boolean start="true"/></ScalarVariable>
  <ScalarVariable name="label" valueReference="0" causality="parameter" variability="fixed">
   <String start="a b"/></ScalarVariable>
  <ScalarVariable name="pi" valueReference="13" variability="constant" causality="local">
   <Real start="3.14"/></ScalarVariable>"""
STRUCTURE2 = """<Outputs><Unknown index="2"/></Outputs><Derivatives><Unknown index="3"/>
 </Derivatives><InitialUnknowns><Unknown index="3"/></InitialUnknowns>"""

FMI3 = """<fmiModelDescription fmiVersion="3.0" modelName="Car" instantiationToken="{{3}}">
 <CoSimulation modelIdentifier="car" canGetAndSetFMUState="true" fixedInternalStepSize="0.01"/>
 <ModelExchange modelIdentifier="car" needsCompletedIntegratorStep="true"/>
 <TypeDefinitions><Float64Type name="Speed" unit="m/s" max="50"/></TypeDefinitions>
 <ModelVariables>
  <UInt64 name="n" valueReference="1" causality="structuralParameter" variability="tunable"
   start="3"/>
  <Float64 name="x" valueReference="2" causality="output" initial="exact" start="1 2 3 4 5 6">
   <Dimension valueReference="1"/><Dimension start="2"/></Float64>
  <Float32 name="v" valueReference="3" causality="output" declaredType="Speed">
   <Alias name="speed"/></Float32>
  <Float64 name="der(x)" valueReference="4" derivative="2"><Dimension valueReference="1"/>
   <Dimension start="2"/></Float64>
  <Int32 name="count" valueReference="5" causality="input" start="7"/>
  <String name="note" valueReference="6" causality="parameter"><Start value="a &amp; b"/></String>
  <Float64 name="z" valueReference="7" causality="local"/>
 </ModelVariables>
 <ModelStructure><Output valueReference="2"/><ContinuousStateDerivative valueReference="4"/>
  <EventIndicator valueReference="7"/>{more}</ModelStructure>
</fmiModelDescription>"""


def refused(kind, *named):
    """The error is of this class, on one line, and its message names all of these."""
    lookaheads = "".join(f"(?=.*{re.escape(str(word))})" for word in named)
    return pytest.raises(kind, match=rf"^{lookaheads}[^\n]+\Z")


@pytest.fixture
def fmu(tmp_path):
    """Writes an FMU from its model description and its other members."""

    def write(description, **members):
        path = tmp_path / "car.fmu"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", description)
            for name, data in members.items():
                archive.writestr(name, data)
        return path

    return write


@pytest.fixture
def fmi2(fmu):
    """Writes an FMI 2 FMU; some text of its model description may be replaced."""

    def write(old="", new="", **members):
        text = FMI2.format(variables=VARIABLES2, structure=STRUCTURE2)
        assert old in text
        return fmu(text.replace(old, new, 1) if old else text, **members)

    return write


# ---- FMI 1 ----


def fmi1(implementation):
    return FMI1.replace("{implementation}", implementation)


def test_fmi1_co_simulation(fmu):
    model = read_model(fmu(fmi1(STAND_ALONE)))
    assert (model.fmi_version, model.name, model.guid) == ("1.0", "Old car", "{1}")
    (interface,) = model.interfaces.values()
    assert (interface.kind, interface.identifier) == (Kind.CO_SIMULATION, "oldcar")
    assert interface.variable_step
    assert interface.once_per_process
    assert not interface.needs_execution_tool
    assert interface.flags["maxOutputDerivativeOrder"] == "2"
    assert model.default_tolerance == 1e-5


def test_fmi1_without_capabilities_can_do_little(fmu):
    (interface,) = read_model(fmu(fmi1(TOOL))).interfaces.values()
    assert interface.needs_execution_tool
    assert not interface.variable_step
    assert not interface.saves_state


def test_fmi1_model_exchange(fmu):
    model = read_model(fmu(fmi1("")))
    (interface,) = model.interfaces.values()
    assert (interface.kind, interface.completed_step_needed) == (Kind.MODEL_EXCHANGE, True)
    assert (model.states, model.event_indicators) == (2, 1)


def test_fmi1_variables_in_the_words_of_the_later_standards(fmu):
    variables = read_model(fmu(fmi1(STAND_ALONE))).variables
    assert (variables["m"].causality, variables["m"].variability) == ("parameter", "fixed")
    assert (variables["v"].unit, variables["v"].minimum) == ("km/h", 0.0)
    assert variables["guess"].initial == "approx"
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


def test_fmi3_interfaces(fmu):
    model = read_model(fmu(FMI3.format(more="")))
    cs, me = model.interfaces.values()
    assert (model.guid, cs.saves_state, cs.fixed_internal_step) == ("{3}", True, 0.01)
    assert me.completed_step_needed


def test_fmi3_arrays_have_the_extent_of_their_structural_parameters(fmu):
    model = read_model(fmu(FMI3.format(more="")))
    x = model.variables["x"]
    assert (x.shape, x.size, x.scalar) == ((3, 2), 6, False)
    assert (model.states, model.event_indicators) == (6, 1)


def test_fmi3_types_defaults_and_aliases(fmu):
    variables = read_model(fmu(FMI3.format(more=""))).variables
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


def test_many_variables(fmu):
    one = '<ScalarVariable name="v{0}" valueReference="{0}"><Real start="1"/></ScalarVariable>'
    variables = "".join(one.format(n) for n in range(50_000))
    model = read_model(fmu(FMI2.format(variables=variables, structure="")))
    assert len(model.variables) == 50_000


def test_fmpys_findings_are_lines(fmi2):
    found = findings(fmi2('name="u"', 'name="u u"'))
    assert found
    assert all(line.isprintable() and len(line) <= 200 for line in found)


# ---- broken descriptions ----

BROKEN = [
    ("no fmiVersion", 'fmiVersion="2.0"', "", "no fmiVersion"),
    ("no guid", 'guid="{2}"', "", "no guid"),
    ("no identifier", 'modelIdentifier="car_cs"', "", "modelIdentifier"),
    ("path as identifier", '"car_cs"', '"../car"', "modelIdentifier"),
    ("same name twice", 'name="v"', 'name="u"', "variable u again"),
    ("no name", 'name="v"', "", "without a name"),
    ("endless name", 'name="v"', f'name="{"v" * 2000}"', "too long"),
    ("name that turns the line", 'name="v"', 'name="v&#x202e;"', "control characters"),
    ("name of two lines", 'name="v"', 'name="v&#10;w"', "control characters"),
    ("no type", '<Boolean start="true"/>', "", "without a type"),
    ("no reference", 'valueReference="10"', "", "valueReference of ScalarVariable u missing"),
    ("reference as text", 'valueReference="10"', 'valueReference="ten"', '"ten"'),
    ("negative reference", 'valueReference="10"', 'valueReference="-1"', "-1"),
    ("huge reference", 'valueReference="10"', 'valueReference="4294967296"', "4294967296"),
    ("start as text", 'start="36"', 'start="fast"', "start of v = fast; expected a number"),
    ("decimal comma", 'start="36"', 'start="3,6"', "start of v = 3,6"),
    ("two starts", 'start="36"', 'start="3 6"', "2 values, expected 1"),
    ("boolean as text", 'start="true"', 'start="yes"', "expected true or false"),
    ("half a gear", 'start="1"/>', 'start="1.5"/>', "expected a whole number"),
    ("limit as text", 'max="90"', 'max="much"', '"much"'),
    ("undefined type", 'declaredType="Speed"', 'declaredType="Spede"', "Spede"),
    ("output that is none", '<Unknown index="2"/>', '<Unknown index="20"/>', "no variable 20 of 7"),
    ("output zero", '<Unknown index="2"/>', '<Unknown index="0"/>', "no variable 0 of 7"),
    ("factor as text", 'factor="0.2777777777777778"', 'factor="3.6 km"', "3.6 km"),
    ("factor zero", 'factor="0.2777777777777778"', 'factor="0"', "factor 0"),
    ("step as text", 'stepSize="0.01"', 'stepSize="10 ms"', "10 ms"),
    ("indicators as text", 'Indicators="3"', 'Indicators="many"', "many"),
]


@pytest.mark.parametrize(
    ("old", "new", "said"), [b[1:] for b in BROKEN], ids=[b[0] for b in BROKEN]
)
def test_a_broken_description_is_refused_with_its_line(fmi2, old, new, said):
    path = fmi2(old, new)
    with refused(FmuFileError, path, "modelDescription.xml, line ", said, "export the model again"):
        read_model(path)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('<Output valueReference="99"/>', "no variable has reference 99"),
        ("<Output/>", "no variable has reference None"),
    ],
)
def test_a_dangling_reference_in_fmi3(fmu, more, said):
    with refused(FmuFileError, "line 20", said):
        read_model(fmu(FMI3.format(more=f"\n{more}")))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('<Dimension valueReference="1"/>', '<Dimension valueReference="9"/>', "no variable"),
        ('start="2"/></Float64>', 'start="-2"/></Float64>', "-2"),
        ('start="2"/></Float64>', 'start="4000000000"/></Float64>', "4000000000"),
        ('start="1 2 3 4 5 6"', 'start="1 2 3 4 5 x"', "x"),
        ('instantiationToken="{3}"', "", "no instantiationToken"),
        ('<Alias name="speed"/>', '<Alias name="x"/>', "variable x again"),
    ],
)
def test_a_broken_description_in_fmi3(fmu, old, new, said):
    text = FMI3.format(more="")
    assert old in text
    with refused(FmuFileError, "line", said):
        read_model(fmu(text.replace(old, new, 1)))


def test_what_the_fmu_says_is_cut_and_cleaned(fmi2):
    path = fmi2('start="36"', f'start="{"x&#x202e;" * 5000}"')
    with pytest.raises(FmuFileError) as caught:
        read_model(path)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < len(str(path)) + 300


def test_texts_are_one_line_of_visible_characters(fmi2):
    rude = "&#x9b;2J&#10;" + "x" * 5000
    model = read_model(fmi2('modelName="Car"', f'modelName="{rude}" description="{rude}"'))
    for text in (model.name, model.description):
        assert text.startswith("?2J xxx")
        assert len(text) <= 500
    unit = read_model(fmi2('unit="N"', f'unit="{rude}"')).variables["u"].unit
    assert unit.isprintable()
    assert len(unit) <= 60
    odd = read_model(fmi2('causality="input"', f'causality="{rude}" variability="{rude}"'))
    for text in (odd.variables["u"].causality, odd.variables["u"].variability):
        assert text.isprintable()
        assert len(text) <= 60


# ---- interfaces that cannot be run ----


@pytest.mark.parametrize("version", ["4.0", "3.1-beta.1", "3.1", "1.1", "2", "", "two"])
def test_another_version_of_fmi(fmi2, version):
    path = fmi2('fmiVersion="2.0"', f'fmiVersion="{version}"')
    with refused(FmuInterfaceError, path, "FMI version", version, "expected 1.0, 2.0 or 3.0"):
        read_model(path)


def test_scheduled_execution_only(fmu):
    text = re.sub("<CoSimulation[^>]*>|<ModelExchange[^>]*>", "", FMI3.format(more=""))
    text = text.replace("<TypeDef", '<ScheduledExecution modelIdentifier="car"/><TypeDef', 1)
    with refused(FmuInterfaceError, "only Scheduled Execution", "export"):
        read_model(fmu(text))


def test_no_interface(fmu):
    text = re.sub("<CoSimulation[^>]*>|<ModelExchange[^>]*>", "", FMI3.format(more=""))
    with refused(FmuInterfaceError, "neither Co-Simulation nor Model Exchange"):
        read_model(fmu(text))


# ---- binaries ----


def elf(machine, kind=3):
    return b"\x7fELF\x02\x01\x01" + bytes(9) + struct.pack("<HH", kind, machine) + bytes(100)


def pe(machine, flags=0x2000):
    head = b"MZ" + bytes(58) + struct.pack("<I", 64)
    return head + b"PE\0\0" + struct.pack("<H", machine) + bytes(16) + struct.pack("<H", flags)


def mach(machine):
    return struct.pack("<IIII", 0xFEEDFACF, machine, 0, 6) + bytes(100)


LINUX, ARM = Platform("x86_64", "linux"), Platform("aarch64", "linux")
WINDOWS, MAC = Platform("x86_64", "windows"), Platform("aarch64", "darwin")


@pytest.mark.parametrize(
    ("start", "platform", "reason"),
    [
        (elf(62), LINUX, ""),
        (elf(183), ARM, ""),
        (pe(0x8664), WINDOWS, ""),
        (mach(0x100000C), MAC, ""),
        (elf(183), LINUX, "is for aarch64"),
        (elf(3), LINUX, "is for x86"),
        (elf(9999), LINUX, "another processor"),
        (elf(62, kind=2), LINUX, "no shared library"),
        (elf(62)[:17], LINUX, "cut off"),
        (pe(0x8664), LINUX, "is for windows"),
        (mach(0x1000007), MAC, "is for x86_64"),
        (pe(0x8664, flags=0), WINDOWS, "no shared library"),
        (b"#!/bin/sh\n", LINUX, "no library"),
        (b"", LINUX, "no library"),
    ],
)
def test_a_library_tells_by_its_first_bytes_where_it_runs(start, platform, reason):
    assert reason in misfit(start, platform)
    assert bool(misfit(start, platform)) == bool(reason)


@pytest.mark.parametrize(
    ("platform", "fmi2", "fmi3"),
    [
        (LINUX, "linux64", "x86_64-linux"),
        (ARM, "aarch64-linux", "aarch64-linux"),  # FMI 2 has no name of its own for it
        (WINDOWS, "win64", "x86_64-windows"),
        (MAC, "darwin64", "aarch64-darwin"),
        (Platform("x86", "windows"), "win32", "x86-windows"),
    ],
)
def test_folders_of_the_standards(platform, fmi2, fmi3):
    assert platform.folders("2.0")[0] == fmi2
    assert platform.folders("3.0")[0] == fmi3
    assert fmi3 in platform.folders("2.0")  # tools use these names there, too


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_the_shipped_fmus_run_on_every_platform(version):
    model = read_model(bundled_fmu(version))
    (interface,) = model.interfaces.values()
    assert binary_of(model, interface).endswith(this_platform().suffix)
    with zipfile.ZipFile(model.path) as archive:
        for platform in (LINUX, ARM, WINDOWS, MAC):
            folders = [f for f in platform.folders(version) if f in model.platforms]
            name = f"binaries/{folders[0]}/{interface.identifier}{platform.suffix}"
            assert misfit(archive.read(name)[:4096], platform) == ""


@pytest.mark.skipif(str(this_platform()) != "x86_64-linux", reason="names this platform")
@pytest.mark.parametrize(
    ("members", "said"),
    [
        ({}, "binaries for: none"),
        ({"binaries/win64/car_cs.dll": b""}, "binaries for: win64; export it for x86_64-linux"),
        ({"sources/car.c": b""}, "fmpy compile"),
        ({"binaries/linux64/car.so": elf(62)}, "but binaries/linux64/car.so"),
        ({"binaries/linux64/car_cs.so": elf(183)}, "car_cs.so is for aarch64"),
        ({"binaries/linux64/car_cs.so": pe(0x8664)}, "car_cs.so is for windows"),
        ({"binaries/linux64/car_cs.so": b"no library"}, "car_cs.so is no library"),
    ],
)
def test_no_binary_for_this_platform(fmi2, members, said):
    model = read_model(fmi2(**members))
    with refused(FmuPlatformError, model.path, said):
        binary_of(model, model.interfaces[Kind.CO_SIMULATION])
