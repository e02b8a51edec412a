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
def test_what_is_written_of_a_study_has_the_same_cells(name):
    definition = read_definition(find_study(name))
    copy = parsed(dump_definition(definition))
    assert copy == definition
    assert design(copy, name) == design(definition, name)


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
