"""The plan of a study: runs, their numbers and their records."""

from __future__ import annotations

import pandas as pd
import pytest

from giveway.studies.definition import (
    parse_definition,
    read_definition,
)
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.study_files import find_study


def test_cells_with_the_same_settings_share_their_records(study_of, tmp_path):
    text = """
        name = "twins"
        replications = 3
        [run]
        time_limit = 0.5
        crowd.pedestrians = 1
        [factors.vehicle]
        "default" = {}
        "as by default" = { regulation = { safe_distance = 1000.0 } }
    """
    from giveway.config import RunConfig

    text = text.replace("1000.0", str(RunConfig().regulation.safe_distance))
    states = []
    study = study_of(text, tmp_path / "twins", states.append)
    assert list(study.runs["run"]) == [f"c{c}-s{s}" for c in (1, 2) for s in (1, 2, 3)]
    assert list(study.execution["run"]) == list(study.runs["run"])
    assert len(list(study.path.glob("records/*/*.json"))) == 3
    assert (states[-1].total, states[-1].made) == (6, 6)
    study_of(text, study.path, states.append, resume=True)
    assert (states[-1].kept, states[-1].made) == (6, 0)


def test_a_level_that_is_added_in_front_renumbers_the_runs(study_of, small_study_text, tmp_path):
    text = small_study_text.replace("= 5", "= 1").replace("[3, 2]", "[2]")
    folder = study_of(text, tmp_path / "more").path
    kept = {path: path.read_bytes() for path in folder.glob("records/*/*.json")}
    study_of(text.replace("[2]", "[1, 2]"), folder, resume=True)
    runs = pd.read_csv(folder / "runs.csv")
    assert list(runs["run"]) == [f"c{cell}-s1" for cell in (1, 2, 3, 4)]
    assert list(runs["crowd.pedestrians"]) == [1, 1, 2, 2]
    assert list(pd.read_csv(folder / "execution.csv")["run"]) == list(runs["run"])
    assert {path: path.read_bytes() for path in kept} == kept
    assert StudyFolder.open(folder).record("c3-s1").run == "c3-s1"


def parsed(text, folder=None, tmp="."):
    from pathlib import Path

    return parse_definition(text, "mine.toml", folder or Path(tmp))


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
        (
            "[primary_outcome]\nmetric = 'delay'\nsmallest_effect = 1\nreason = 'r'\n"
            "[factors]\ncontroller = ['mpc', 'pid']",
            "[primary_outcome] metric 'delay': no such number to compare; ",
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


@pytest.mark.parametrize(
    ("cells", "level", "said"),
    [
        (
            "cells = [{ scene = 'few' }]",
            "{ crowd.pedestrians = true }",
            "[crowd] pedestrians = True",
        ),
        (
            "only = { scene = ['few'] }",
            "{ crowd.pedestrians = true }",
            "[crowd] pedestrians = True",
        ),
        ("cells = [{ scene = 'few' }]", "{ scenario = 'nowhere' }", "unknown scenario 'nowhere'"),
    ],
)
def test_a_level_that_no_cell_has_is_checked_too(cells, level, said):
    from giveway.errors import GivewayError

    text = f"name = 'mine'\n{cells}\n[factors.scene]\nfew = {{}}\n'other, 2' = {level}\n"
    with pytest.raises(GivewayError) as refused:
        planned(text)
    assert str(refused.value).startswith("mine.toml: [factors] scene = other, 2: ")
    assert said in str(refused.value)


def test_a_level_that_needs_another_factors_level_is_valid_without_a_cell():
    text = """
        name = "mine"
        [run]
        controller = "pid"
        [factors]
        controller = ["pid", "mpc"]
        [factors.horizon]
        none = {}
        short = { controller_options = { horizon = 1.0 } }
        long = { controller_options = { horizon = 4.0 } }
        [[cells]]
        controller = "mpc"
        horizon = "short"
        [[cells]]
        controller = "pid"
        horizon = "none"
    """
    assert len(planned(text).cells) == 2


def test_without_a_controller_factor_the_last_one_is_compared():
    from giveway.studies.plan import plan

    text = 'name = "mine"\n[factors]\n"crowd.pedestrians" = [1, 2]\n"vehicle.mass" = [900, 1100]\n'
    comparison = plan(parsed(text), "mine.toml").definition.comparison
    assert (comparison.factor, comparison.baseline) == ("vehicle.mass", "1100")


def planned(text):
    from giveway.studies.plan import plan

    return plan(parsed(text), "mine.toml")


_RIVALS = """
    name = "rivals"
    replications = 1
    [run]
    crowd.pedestrians = 3
    [factors]
    controller = [{controllers}]
"""


@pytest.mark.parametrize(
    ("controllers", "preset"),
    [
        ("'mpc', 'pid-tuned'", "MIXED"),
        ("'mpc-paper', 'pid-paper'", "SIM"),
        ("'mpc-paper', 'mpc'", "MIXED"),
        ("'mpc', 'mpc-paper'", "MIXED"),
    ],
)
def test_rivals_meet_the_same_people(controllers, preset):
    from giveway.studies.plan import plan

    found = planned(_RIVALS.format(controllers=controllers))
    assert [cell.config.crowd.preset for cell in found.cells] == [preset, preset]
    again = plan(found.definition, "again.toml")
    assert [cell.digest for cell in again.cells] == [cell.digest for cell in found.cells]


def test_a_preset_that_a_study_names_counts_for_all():
    text = _RIVALS.format(controllers="'mpc-paper', 'mpc'")
    found = planned(text.replace("3\n", "3\n    crowd.preset = 'SIM'\n", 1))
    assert [cell.config.crowd.preset for cell in found.cells] == ["SIM", "SIM"]
    varied = planned(text + "    'crowd.preset' = ['CITR', 'TABLE2']\n")
    presets = [cell.config.crowd.preset for cell in varied.cells]
    assert presets == ["CITR", "TABLE2", "CITR", "TABLE2"]
