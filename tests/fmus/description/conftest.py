"""Model descriptions of FMI 1, 2 and 3."""

from __future__ import annotations

import zipfile

import pytest

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


@pytest.fixture
def fmi1_xml():
    """A model description of FMI 1 with this Implementation."""
    return lambda implementation="": FMI1.replace("{implementation}", implementation)


@pytest.fixture
def fmi2_xml():
    """A model description of FMI 2 with these variables."""
    return lambda variables, structure="": FMI2.format(variables=variables, structure=structure)


@pytest.fixture
def fmi3_xml():
    """A model description of FMI 3 with something more in it."""
    return lambda more="": FMI3.format(more=more)


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
