"""Systems of several FMUs: SSP 1.0 read as one model, and what is refused."""

from __future__ import annotations

import zipfile

import pytest
from fmpy.ssp.ssd import read_ssd
from support.fmus.ssp import write_ssp

from fmus import FmuFileError, FmuVariableError
from fmus.description.model import Link
from fmus.description.reading import read_model

KN = {"force": ("kN", 1e3, 0.0)}


@pytest.fixture
def system(zoo, tmp_path):
    """Writes a system of an actuator and a chassis; connections and connectors may differ."""

    def write(connections=None, connectors=None, **options):
        engine = zoo.car(
            names={"force": "demand", "speed": "torque"},
            units={"speed": ("N", 1.0, 0.0)},
            outputs=("speed",),
            initial=(),
            file="engine",
        )
        chassis = zoo.car(units=KN, outputs=("speed", "position"), extra=("spare_input",))
        connections = connections or [
            ("drive", "engine.demand"),
            ("engine.torque", "chassis.force"),
            ("chassis.speed", "v"),
        ]
        connectors = connectors or {
            "drive": ("input", ""),
            "v": ("output", "km/h"),
            "engine.demand": ("input", "N"),
            "engine.torque": ("output", "N"),
            "chassis.force": ("input", ""),
            "chassis.speed": ("output", ""),
        }
        parts = {"engine": engine, "chassis": chassis}
        return write_ssp(tmp_path / "car.ssp", parts, connections, connectors, **options)

    return write


def test_the_files_of_these_tests_are_ssp(system):
    described = read_ssd(str(system(values={"chassis.mass": 1300.0})), validate=True)
    assert [element.name for element in described.system.elements] == ["engine", "chassis"]


def test_it_is_one_model_with_the_variables_of_all(system):
    path = system(values={"chassis.mass": 1300.0}, linear={"chassis.force": (2.0, 0.5)})
    model = read_model(path)
    parts = model.system
    assert parts.links == (Link("engine.torque", "chassis.force", 2e-3, 0.5),)  # N to kN
    assert parts.inputs == {"drive": (Link("drive", "engine.demand"),)}
    assert parts.outputs["v"].gain == pytest.approx(3.6)
    assert parts.values == {"chassis.mass": 1300.0}
    told = {name: model.variables[name] for name in ("drive", "v", "chassis.force", "chassis.mass")}
    assert [variable.causality for variable in told.values()] == [
        "input", "output", "local", "parameter",
    ]  # fmt: skip
    assert told["chassis.mass"].start == "1300.0"
    assert told["v"].unit == "km/h"
    assert parts.doubts == ()


def test_a_parameter_of_the_system_sets_that_of_a_part(system):
    connectors = {"weight": ("parameter", "t"), "chassis.mass": ("parameter", "kg")}
    path = system([("weight", "chassis.mass")], connectors, values={"weight": 1.3})
    assert read_model(path).system.values == {"weight": 1.3}
    assert read_model(path).system.inputs["weight"][0].gain == 1e3
    assert read_model(path).variables["weight"].causality == "parameter"


@pytest.mark.parametrize(
    ("connection", "connector", "said"),
    [
        (("gearbox.out", "chassis.force"), {}, "connector 'gearbox.out': no such part"),
        (("engine.tork", "chassis.force"), {"engine.tork": ("output", "N")}, "'tork'"),
        (("chassis.speed", "chassis.force"), {}, "is in 'm/s', but chassis.force in 'kN'"),
    ],
)
def test_a_connection_that_cannot_be_is_refused(system, refused, connection, connector, said):
    usual = {
        "drive": ("input", "N"),
        "engine.demand": ("input", "N"),
        "chassis.force": ("input", ""),
        "chassis.speed": ("output", ""),
        connection[0]: ("output", ""),
    }
    path = system([("drive", "engine.demand"), connection], usual | connector)
    with refused(FmuVariableError, path, said):
        read_model(path)


def test_two_connections_to_one_input_are_refused(system, refused):
    path = system([("drive", "chassis.force"), ("engine.torque", "chassis.force")])
    with refused(FmuFileError, path, "a second connection to chassis.force"):
        read_model(path)


SSV = """<v:ParameterSet xmlns:v="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
 xmlns:c="http://ssp-standard.org/SSP1/SystemStructureCommon" version="1.0" name="own">
 <v:Parameters><v:Parameter name="weight"><v:Real value="1.3" unit="t"/></v:Parameter>
 <v:Parameter name="on"><v:Boolean value="true"/></v:Parameter>
 <v:Parameter name="unused"><v:Real value="7"/></v:Parameter></v:Parameters>
 <v:Units><c:Unit name="t"><c:BaseUnit kg="1" factor="1000"/></c:Unit></v:Units>
</v:ParameterSet>"""
SSM = """<m:ParameterMapping xmlns:m="http://ssp-standard.org/SSP1/SystemStructureParameterMapping"
 version="1.0"><m:MappingEntry source="weight" target="chassis.mass"/>
 <m:MappingEntry source="on" target="chassis.engaged"/></m:ParameterMapping>"""
BINDING = """<ssd:ParameterBindings><ssd:ParameterBinding source="own.ssv">
 <ssd:ParameterMapping source="own.ssm"/></ssd:ParameterBinding></ssd:ParameterBindings>"""


@pytest.mark.parametrize("members", [("own.ssv", "own.ssm"), ("own.ssm",)])
def test_parameters_of_a_file_are_renamed_and_converted(system, refused, members):
    path = system()
    other = path.with_name("own.ssp")
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(other, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            if name == "SystemStructure.ssd":
                data = data.replace(b"<ssd:Elements>", BINDING.encode() + b"<ssd:Elements>")
            new.writestr(name, data)
        for name in members:
            new.writestr(name, {"own.ssv": SSV, "own.ssm": SSM}[name])
    if len(members) == 2:
        values = read_model(other).system.values
        assert values == {"chassis.mass": 1300.0, "chassis.engaged": True}
        return
    with refused(FmuFileError, other, "own.ssv: no such file in the archive"):
        read_model(other)


def test_a_hostile_description_is_refused(tmp_path, refused):
    path = tmp_path / "car.ssp"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("SystemStructure.ssd", "<!DOCTYPE x><SystemStructureDescription/>")
    with refused(FmuFileError, path, "DOCTYPE"):
        read_model(path)
