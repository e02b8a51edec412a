"""The design of a study: factors, levels and cells."""

import pytest

from giveway.errors import ConfigError
from giveway.studies.definition import (
    dump_definition,
    parse_definition,
)
from giveway.studies.design import design

MINIMAL = 'name = "mine"\n[factors]\ncontroller = ["mpc", "pid"]\n'


def parsed(text, folder=None, tmp="."):
    from pathlib import Path

    return parse_definition(text, "mine.toml", folder or Path(tmp))


def cells(text):
    return [cell.label for cell in design(parsed(text), "mine.toml").cells]


def test_a_grid_has_every_combination_in_the_order_of_the_file():
    text = MINIMAL + '"crowd.pedestrians" = [2, 1]\n'
    assert cells(text) == [
        "controller = mpc, crowd.pedestrians = 2",
        "controller = mpc, crowd.pedestrians = 1",
        "controller = pid, crowd.pedestrians = 2",
        "controller = pid, crowd.pedestrians = 1",
    ]


def test_an_option_without_quotes_means_the_same():
    quoted = cells(MINIMAL + '"vehicle.mass" = [900, 1000]\n"vehicle.friction" = [100]\n')
    assert cells(MINIMAL + "vehicle.mass = [900, 1000]\nvehicle.friction = [100]\n") == quoted


@pytest.mark.parametrize("name", ["=a", "+a", "-a", "@a", "\\ta"])
def test_a_name_that_spreadsheets_take_for_a_formula_is_refused(name):
    fine = "{ controller = 'pid' }"
    for text in (
        f'name = "{name}"\n[factors]\ncontroller = ["mpc"]',
        f'name = "s"\n[factors.driver]\n"{name}" = {fine}',
        f'name = "s"\n[factors."{name}"]\n"a" = {fine}',
    ):
        with pytest.raises(ConfigError, match=r"should|expected letters"):
            cells(text)


def test_named_levels_may_set_several_options():
    text = """
        name = "mine"
        [factors.driver]
        "short MPC" = { controller = "mpc", controller_options = { horizon = 1.5 } }
        "soft PID" = { controller = "pid", controller_options = { proportional_gain = 300 } }
        [comparison]
        factor = "driver"
    """
    definition = parsed(text + "[run.controller_options]\nintegral_gain = 0\n")
    made = design(definition, "mine.toml")
    layer = made.cells[1].layer("mine.toml", definition)
    assert layer.values == {
        "controller": "pid",
        "controller_options": {"integral_gain": 0, "proportional_gain": 300},
    }


def test_listed_cells_are_run_instead_of_the_grid():
    text = """
        name = "mine"
        cells = [
            { controller = "mpc", "crowd.pedestrians" = 2 },
            { controller = "pid", crowd = { pedestrians = 1 } },
        ]
        [factors]
        controller = ["mpc", "pid"]
        "crowd.pedestrians" = [1, 2]
    """
    assert cells(text) == [
        "controller = mpc, crowd.pedestrians = 2",
        "controller = pid, crowd.pedestrians = 1",
    ]


def test_files_are_relative_to_the_study_file(tmp_path):
    (tmp_path / "car.fmu").touch()
    text = MINIMAL + '"vehicle.fmu" = ["fmi2", "./car.fmu"]\n[run.vehicle]\nprofile = "./no.toml"\n'
    definition = parsed(text, tmp_path)
    here = str(tmp_path / "car.fmu")
    cell = design(definition, "mine.toml").cells[1]
    assert cell.label == "controller = mpc, vehicle.fmu = ./car.fmu"  # as it was written
    vehicle = cell.layer("mine.toml", definition).values["vehicle"]
    assert vehicle == {"fmu": here, "profile": "./no.toml"}  # there is none: said later


@pytest.mark.parametrize("factor", ['"vehicle.fmu" =', "vehicle.fmu ="])
def test_a_level_that_is_a_file_is_called_as_it_was_written(tmp_path, factor):
    (tmp_path / "ä car.fmu").touch()
    text = f"""
        name = "mine"
        cells = [{{ {factor} "./ä car.fmu" }}]
        [factors]
        {factor} ["fmi2", "./ä car.fmu"]
        [comparison]
        factor = "vehicle.fmu"
        baseline = "./ä car.fmu"
    """
    definition = parsed(text, tmp_path)
    (cell,) = design(definition, "mine.toml").cells
    assert cell.levels["vehicle.fmu"].value == "./ä car.fmu"
    settings = cell.layer("mine.toml", definition).values
    assert settings["vehicle"]["fmu"] == str(tmp_path / "ä car.fmu")
    copy = parsed(dump_definition(definition), tmp_path / "elsewhere")
    assert cell.layer("mine.toml", copy).values == settings


def test_named_levels_before_options_keep_their_place():
    """In plain TOML tables they would move behind the lists, and the cells' numbers with them."""
    text = """
        name = "mine"
        cells = [{ 'my "driver"' = "a, b", crowd = { pedestrians = 2 }, controller = "pid" }]
        [factors.'my "driver"']
        "<ä>" = { vehicle = { friction = 1e-9 } }
        "a, b" = {}
        [factors]
        crowd.pedestrians = [2, 1]
        controller = ["mpc", "pid"]
    """
    made = design(parsed(text), "mine.toml")
    assert [f.name for f in made.factors] == ['my "driver"', "crowd.pedestrians", "controller"]
    assert design(parsed(dump_definition(parsed(text))), "mine.toml") == made


def test_nothing_as_a_level_can_be_seen_in_the_tables():
    text = 'name = "mine"\n[factors]\n"ego.take_over" = [[], ["bus"]]\n"vehicle.profile" = [""]\n'
    cell = design(parsed(text), "mine.toml").cells[0]
    assert cell.label == "ego.take_over = none, vehicle.profile = none"
    assert [level.value for level in cell.levels.values()] == ["none", "none"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("", "factors: missing"),
        ("[factors]", "expected at least one factor"),
        ("name = 'a b'\n[factors]\ncontroller = ['mpc']", "name = 'a b': expected letters"),
        ("name = '..'\n[factors]\ncontroller = ['mpc']", "name = '..': expected letters"),
        ("replicatons = 3\n[factors]\ncontroller = ['mpc']", "replicatons: unknown key"),
        ("replications = 0\n[factors]\ncontroller = ['mpc']", "replications = 0"),
        ("[factors]\ncontroler = ['mpc']", "did you mean 'controller'?"),
        ("[factors]\nseed = [1, 2]", "replications and first_seed"),
        ("[factors]\ncontroller = []", "controller: no levels"),
        ("[factors]\ncontroller = ['mpc', 'mpc']", "level 'mpc' twice"),
        ("[factors]\ncontroller = 'mpc'", "expected a list of values"),
        ("[factors.ego]\na = {controller = 'mpc'}", "name is taken"),
        ("[factors.stops]\na = {controller = 'mpc'}", "name is taken"),
        ("cells = [{}]\n[factors]\ncontroller = ['mpc']", "cells[0]: no level of 'controller'"),
        ("cells = [{controller = 'x'}]\n[factors]\ncontroller = ['mpc']", "expected one of mpc"),
        ("cells = [{driver = 'x'}]\n[factors]\ncontroller = ['mpc']", "unknown factor 'driver'"),
        (
            "first_seed = 2147483647\nreplications = 5\n[factors]\ncontroller = ['mpc']",
            "the last seed would be beyond",
        ),
        ("[factors.driver]", "driver = {}: expected a list of values"),
        ("[factors.driver]\n' ' = {}", "driver: level ' ': expected a name"),
        ("[factors.driver]\na = {seed = 3}", "driver.a: seed = 3: every cell is run with the same"),
        ("[run]\nseed = 3\n[factors]\ncontroller = ['mpc']", "[run] seed = 3: every cell"),
        ("[precision]\nwidth = 0\n[factors]\ncontroller = ['mpc']", "precision.width = 0"),
        ("[precision]\n[factors]\ncontroller = ['mpc']", "precision.width: missing"),
    ],
)
def test_what_cannot_be_a_study_is_refused_in_one_line(change, said):
    named = "" if change.startswith("name") else 'name = "mine"\n'
    with pytest.raises(ConfigError) as refused:
        design(parsed(named + change), "mine.toml")
    assert said in str(refused.value)
    assert str(refused.value).startswith("mine.toml")
    assert "\n" not in str(refused.value)
