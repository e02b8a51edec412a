"""Study files: what they may hold, and what is said of what they may not."""

import pytest

from giveway.config.files.loading import load
from giveway.config.tables.controllers import PaperPidOptions
from giveway.errors import ConfigError
from giveway.studies.definition import (
    dump_definition,
    parse_definition,
    read_definition,
)
from giveway.studies.design import design
from giveway.studies.study_files import bundled_studies, find_study

MINIMAL = 'name = "mine"\n[factors]\ncontroller = ["mpc", "pid"]\n'


def parsed(text, folder=None, tmp="."):
    from pathlib import Path

    return parse_definition(text, "mine.toml", folder or Path(tmp))


def cells(text):
    return [cell.label for cell in design(parsed(text), "mine.toml").cells]


def test_a_study_in_three_lines_compares_two_controllers():
    definition = parsed(MINIMAL)
    assert definition.replications == 100
    assert definition.comparison.factor == "controller"
    assert cells(MINIMAL) == ["controller = mpc", "controller = pid"]


@pytest.mark.parametrize("name", bundled_studies())
def test_every_bundled_study_can_be_planned(name):
    from giveway.studies.plan import plan

    planned = plan(read_definition(find_study(name)), name)
    assert len(planned) == len(planned.cells) * planned.definition.replications
    assert len({cell.digest for cell in planned.cells}) == len(planned.cells)


def test_the_papers_study_is_twelve_thousand_runs():
    from giveway.studies.plan import plan

    planned = plan(read_definition(find_study("paper")), "paper")
    assert len(planned) == 12_000
    labels = [planned.cell.label for planned in planned.cells]
    assert labels == [
        f"crowd.pedestrians = {n}, controller = {c}-paper"
        for n in (30, 20, 10)
        for c in ("mpc", "pid")
    ]


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


@pytest.mark.parametrize("name", bundled_studies())
def test_what_is_written_of_a_study_has_the_same_cells(name):
    definition = read_definition(find_study(name))
    copy = parsed(dump_definition(definition))
    assert copy == definition
    assert design(copy, name) == design(definition, name)


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


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[factors]\ncontroller = ['mpc', 'nobody']", "cell 2 (controller = nobody)"),
        ("[run]\nscenario = 'nowhere'\n[factors]\ncontroller = ['mpc']", "nowhere"),
        ("[factors]\n'controller_options.horizon' = [2.5, 0.1]", "horizon"),
        (
            "[run.controller_options]\nstyle = 'careful'\n[factors]\ncontroller = ['mpc', 'pid']",
            "style: 'pid-paper' has no such option",
        ),
        ("[comparison]\nfactor = 'x'\n[factors]\ncontroller = ['mpc']", "factor 'x'"),
        (
            "[comparison]\nbaseline = 'x'\n[factors]\ncontroller = ['mpc', 'pid']",
            "baseline = 'x': expected one of mpc, pid",
        ),
        (
            "[precision]\nwidth = 1\nmetric = 'x'\n[factors]\ncontroller = ['mpc', 'pid']",
            "[precision] ",
        ),
    ],
)
def test_a_cell_that_cannot_be_run_is_found_before_anything_runs(text, said):
    from giveway.errors import GivewayError
    from giveway.studies.plan import plan

    with pytest.raises(GivewayError) as refused:
        plan(parsed('name = "mine"\n' + text), "mine.toml")
    assert said in str(refused.value)
    assert "mine.toml" in str(refused.value)


def test_an_unknown_study_names_the_known_ones():
    known = "ablation, beliefs, controllers, law, models, paper, readings, styles"
    with pytest.raises(ConfigError, match=rf"expected a \.toml file or one of {known}"):
        find_study("papper")


def test_files_that_are_no_study(tmp_path):
    with pytest.raises(ConfigError, match="no such file"):
        read_definition(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_bytes(b"name = \xff")
    with pytest.raises(ConfigError, match="not UTF-8"):
        read_definition(broken)
    broken.write_text("name = ")
    with pytest.raises(ConfigError, match="not valid TOML"):
        read_definition(broken)


def test_without_a_controller_factor_the_last_one_is_compared():
    from giveway.studies.plan import plan

    text = 'name = "mine"\n[factors]\n"crowd.pedestrians" = [1, 2]\n"vehicle.mass" = [900, 1100]\n'
    comparison = plan(parsed(text), "mine.toml").definition.comparison
    assert (comparison.factor, comparison.baseline) == ("vehicle.mass", "1100")


def test_the_readings_of_the_paper_reach_both_of_its_controllers():
    definition = read_definition(find_study("readings"))
    found = set()
    for cell in design(definition, "readings").cells:
        (ego,) = load([cell.layer("readings", definition)])[0].each_ego()
        if cell.levels["reading"].label == "K_p = 300, as printed":
            found.add((ego.controller, ego.own(PaperPidOptions).proportional_gain))
    assert found == {("mpc-paper", 300.0), ("pid-paper", 300.0)}


def test_the_study_of_controllers_compares_all_in_every_scene():
    from giveway.studies.plan import plan

    planned = plan(read_definition(find_study("controllers")), "controllers")
    scene, controller = planned.design.factors
    assert [level.label for level in controller.levels] == [
        "mpc",
        "pid-tuned",
        "mpc-paper",
        "pid-paper",
    ]
    assert len(planned.cells) == len(scene.levels) * 4 == 88
    assert planned.definition.table == "levels"


def planned(text):
    from giveway.studies.plan import plan

    return plan(parsed(text), "mine.toml")


@pytest.mark.parametrize(
    "factor",
    [
        '"crowd.pedestrians" = [10, 0]',
        '"crowd.desired_speed_mean" = [1.2, 1.5]\n[run]\ncrowd.pedestrians = 0',
        'few = { "nobody" = { crowd = { pedestrians = 0 } }, "ten" = {} }',
    ],
)
def test_a_study_of_crowds_has_somebody_in_every_cell(factor):
    with pytest.raises(ConfigError, match=r"mine.toml: cell \d .*pedestrians = 0: expected .* 1"):
        planned(f'name = "m"\n[factors]\n{factor}\n')


def test_a_scenarios_own_people_or_no_crowd_suffice(tmp_path):
    planned(MINIMAL + "[run]\ncrowd.pedestrians = 0\n")
    planned('name = "m"\n[run]\nscenario = "junction"\n[factors]\n"crowd.pedestrians" = [0, 5]\n')
