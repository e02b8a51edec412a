"""Broken model descriptions are refused with their line."""

from __future__ import annotations

import re

import pytest

from fmus.description.channels import find_channel, start_channels
from fmus.description.reading import read_model
from fmus.errors import FmuFileError, FmuInterfaceError, FmuVariableError

# ---- broken descriptions ----

BROKEN = [
    ("no fmiVersion", 'fmiVersion="2.0"', "", "no fmiVersion"),
    ("no guid", 'guid="{2}"', "", "no guid"),
    ("no identifier", 'modelIdentifier="car_cs"', "", "modelIdentifier"),
    ("path as identifier", '"car_cs"', '"../car"', "modelIdentifier"),
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
def test_a_broken_description_is_refused_with_its_line(fmi2, old, new, said, refused):
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
def test_a_dangling_reference_in_fmi3(fmu, more, said, refused, fmi3_xml):
    with refused(FmuFileError, "line 20", said):
        read_model(fmu(fmi3_xml(f"\n{more}")))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('<Dimension valueReference="1"/>', '<Dimension valueReference="9"/>', "no variable"),
        ('start="2"/></Float64>', 'start="-2"/></Float64>', "-2"),
        ('start="2"/></Float64>', 'start="4000000000"/></Float64>', "4000000000"),
        ('start="1 2 3 4 5 6"', 'start="1 2 3 4 5 x"', "x"),
        ('instantiationToken="{3}"', "", "no instantiationToken"),
    ],
)
def test_a_broken_description_in_fmi3(fmu, old, new, said, refused, fmi3_xml):
    text = fmi3_xml()
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
def test_another_version_of_fmi(fmi2, version, refused):
    path = fmi2('fmiVersion="2.0"', f'fmiVersion="{version}"')
    with refused(FmuInterfaceError, path, "FMI version", version, "expected 1.0, 2.0 or 3.0"):
        read_model(path)


def test_scheduled_execution_only(fmu, refused, fmi3_xml):
    text = re.sub("<CoSimulation[^>]*>|<ModelExchange[^>]*>", "", fmi3_xml())
    text = text.replace("<TypeDef", '<ScheduledExecution modelIdentifier="car"/><TypeDef', 1)
    with refused(FmuInterfaceError, "only Scheduled Execution", "export"):
        read_model(fmu(text))


def test_no_interface(fmu, refused, fmi3_xml):
    text = re.sub("<CoSimulation[^>]*>|<ModelExchange[^>]*>", "", fmi3_xml())
    with refused(FmuInterfaceError, "neither Co-Simulation nor Model Exchange"):
        read_model(fmu(text))


def test_a_name_given_twice_matters_only_where_it_is_used(fmi2, fmu, fmi3_xml, refused):
    twice = read_model(fmi2('name="v"', 'name="u"'))
    assert find_channel(twice, "test:", "gear").name == "gear"
    with refused(FmuVariableError, twice.path, "test: variable 'u'", "again on line"):
        find_channel(twice, "test:", "u")
    with refused(FmuVariableError, twice.path, "start value: variable 'u'", "again on line"):
        start_channels(twice, {"u": 1.0})
    aliased = fmi3_xml().replace('<Alias name="speed"/>', '<Alias name="x"/>')
    with refused(FmuVariableError, "variable 'x'", "again on line"):
        find_channel(read_model(fmu(aliased)), "test:", "x")
