"""Somebody else's people walk, as docs/own_pedestrians.md prints them: runs, twins, studies."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pandas as pd
import pytest
from support.plug_ins import printed

import giveway
from giveway.config import RunConfig
from giveway.config.files.layers import dump_toml, read_toml
from giveway.config.files.loading import load
from giveway.cosimulation.counterfactual import counterfactual
from giveway.cosimulation.counterfactual.follow_up import Beginning
from giveway.errors import ConfigError, ControlError, CrowdError
from giveway.plug_ins.conformance import check_model
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import checked_run
from pedestrian_model import Crowd, ModelSetup

GROUP = "giveway.pedestrian_models"
SHORT = {"controller": "pid-tuned", "time_limit": 2.0}

FAULTY = """
import os, time
import numpy as np
from dataclasses import dataclass

@dataclass
class Fault:
    kind: str = "none"

class People:
    Options = Fault
    def __init__(self, setup, options):
        self.kind, self.asked = options.kind, 0
    def step(self, walkers):
        self.asked += 1
        answer = np.zeros((len(walkers.ids), 2))
        if self.asked <= 20:
            return answer
        if self.kind == "nan":
            answer[2, 1] = np.nan
        if self.kind == "shape":
            return answer.T
        if self.kind == "raise":
            raise ValueError("no idea")
        if self.kind == "write":
            walkers.position[:] = 0.0
        if self.kind == "exit":
            os._exit(0)
        return answer
"""


@pytest.fixture
def shy(installed):
    """The package of the page."""
    points = tomllib.loads(printed("file: shy pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points[GROUP].items()
    text = printed("file: shy_people.py")
    assert len(text.splitlines()) <= 60
    return installed("shy_people", text, declares=f"{name} = {value}", group=GROUP)


@pytest.fixture
def faulty(installed):
    return installed("faulty_people", FAULTY, declares="odd = faulty_people:People", group=GROUP)


def test_the_guides_people_walk_as_their_settings_say(shy, tmp_path):
    settings = tomllib.loads(printed("shy run"))
    settings["crowd"]["pedestrians"] = 30
    out = tmp_path / "run"
    result = giveway.run(settings | {"seed": 3, "twin": True}, results=out, pictures=False)
    assert result.summary["ending"] == "completed"
    assert result.summary["frontal_contacts"] == 0
    assert np.isfinite(result.summary["mean_people_delay"])
    told = json.loads((out / "manifest.json").read_text(encoding="utf-8"))
    told = told["pedestrian_models"]["the crowd"]
    assert told["distribution"] == "shy-people"
    assert told["options"] == {"look": 3.0, "margin": 0.5}
    config, _ = load([read_toml(out / "config.toml")])
    assert config.model_options == {"look": 3.0}
    again = giveway.run(out / "config.toml", pictures=False)
    assert np.array_equal(again.crowd_track.x, result.crowd_track.x)
    other = settings | {"seed": 3, "model_options": {"look": 0.5}}
    far = giveway.run(other, pictures=False).crowd_track
    assert not np.array_equal(far.x, result.crowd_track.x)


def test_a_plugged_in_model_walks_on_roads_with_walls_and_lights(shy):
    crowd = {"model": "shy", "walls": True}
    run = {"scenario": "junction", "seed": 2, "time_limit": 40.0, "crowd": crowd}
    result = giveway.run(run, pictures=False)
    assert result.facts["pedestrians"]["taken_over"] > 3
    assert result.summary["failures_to_yield"] == 0


def test_the_configuration_as_it_is_written_is_the_configuration(shy):
    config = RunConfig(crowd={"model": "shy"}, model_options={"look": 3.0})
    assert RunConfig.model_validate(tomllib.loads(dump_toml(config))) == config
    with pytest.raises(ConfigError, match="look: 'vci' has no such option; expected one of"):
        giveway.run({"model_options.look": 1.0})


def test_options_of_the_command_line_go_to_the_model_named_last(shy, type_here, tmp_path):
    words = ["--crowd-model", "shy", "--set-model", "look=1.25"]
    typed = type_here("config", *words)
    assert tomllib.loads(typed.stdout)["model_options"] == {"look": 1.25}
    file = tmp_path / "shy.toml"
    file.write_text(printed("shy run"), encoding="utf-8")
    typed = type_here("config", "--config", file, "--crowd-model", "social-force")
    assert typed.returncode == 0
    assert "model_options" not in tomllib.loads(typed.stdout)
    refused = type_here("run", "--crowd-model", "shy", "--set-model", "lok=1", "-q")
    assert refused.returncode == 2
    assert "[model_options] lok: 'shy' has no such option; did you mean 'look'?" in refused.stderr
    unknown = type_here("run", "--crowd-model", "shi", "-q")
    assert unknown.returncode == 2
    assert "--crowd-model = 'shi': expected 'vci'" in unknown.stderr


FAULTS = {
    "nan": r"pedestrian 'ped\w+': 'odd' returned \[0.0, nan\]: expected finite numbers \[m/s\^2\]",
    "shape": r"'odd' returned array\(.*: expected Accelerations or Velocities of \(5, 2\) numbers",
    "raise": r"'odd' raised ValueError: no idea \(faulty_people.py:\d+\)",
    "write": r"'odd' raised ValueError: assignment destination is read-only \(faulty_people.py:",
}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_ends_the_run_with_one_line_and_keeps_its_rows(faulty, kind, tmp_path):
    settings = {"model_options": {"kind": kind}, "crowd": {"pedestrians": 5, "model": "odd"}}
    with pytest.raises(CrowdError) as caught:
        giveway.run(settings | SHORT, results=tmp_path / "run", pictures=False)
    assert re.match(rf"crowd at step 20: {FAULTS[kind]}", str(caught.value)), caught.value
    assert str(caught.value).isprintable()
    assert len(pd.read_csv(tmp_path / "run" / "ego.csv")) >= 20


def test_faults_in_a_study_are_a_row_each_beside_sound_runs(faulty, study_of, tmp_path):
    text = """
name = "faults"
replications = 1
[run]
controller = "pid-tuned"
time_limit = 2.0
crowd = { pedestrians = 3, model = "odd" }
[factors]
"model_options.kind" = ["none", "nan", "exit"]
"""
    study = study_of(text, tmp_path / "study", jobs=1, hang_limit=10.0)
    failures = study.failures.set_index("run")["cause"]
    assert sorted(failures.index) == ["c2-s1", "c3-s1"]
    assert "'odd' returned" in failures["c2-s1"]
    assert re.search(r"exit\(0\) .* in the pedestrian model 'odd' at .*step 20", failures["c3-s1"])


def test_a_results_folder_is_not_believed(shy, tmp_path):
    for name in ("shy", "shy_people:Shy"):
        settings = {"crowd": {"model": name, "pedestrians": 3}, "time_limit": 0.2}
        giveway.run(settings, results=tmp_path / name.replace(":", "-"), pictures=False)
    declared, named = tmp_path / "shy", tmp_path / "shy_people-Shy"
    assert load([read_toml(declared / "config.toml")])
    with pytest.raises(ConfigError, match="--crowd-model shy_people:Shy"):
        load([read_toml(named / "config.toml")])
    assert load([read_toml(named / "config.toml")], trusted={"shy_people:Shy"})
    shy.write_text(shy.read_text(encoding="utf-8") + "# other\n", encoding="utf-8")
    with pytest.raises(ConfigError, match="made with another content of shy-people"):
        load([read_toml(declared / "config.toml")])


def test_a_study_is_resumed_with_what_it_was_made_with(shy, study_of, tmp_path):
    text = """
name = "people"
replications = 1
[run]
controller = "pid-tuned"
time_limit = 1.0
crowd = { pedestrians = 3 }
[factors]
"crowd.model" = ["shy", "vci"]
"""
    study = study_of(text, tmp_path / "study")
    keys = {record.run: record.key for _, _, record in study.records}
    shy.write_text(shy.read_text(encoding="utf-8") + "# other\n", encoding="utf-8")
    with pytest.raises(ConfigError, match="made with another content of shy-people"):
        checked_run(StudyFolder.open(study.path), "c1-s1")
    resumed = study_of(text, tmp_path / "study", resume=True)
    again = {record.run: record.key for _, _, record in resumed.records}
    assert again["c2-s1"] == keys["c2-s1"]
    assert again["c1-s1"] != keys["c1-s1"]


def test_check_tells_in_words_whether_a_model_keeps_to_the_rules(shy, faulty, type_here):
    typed = type_here("check", "model", "shy", "--set", "look=1.5")
    assert typed.returncode == 0, typed.stdout
    assert "shy: sound" in typed.stdout
    typed = type_here("check", "model", "odd", "--set", "kind=nan")
    assert typed.returncode == 1
    assert "broken  answers numbers" in typed.stdout
    assert type_here("check", "model", "vci").returncode == 2
    from shy_people import Shy, ShyOptions

    findings = check_model(
        lambda setup: Shy(setup, ShyOptions()), ModelSetup(0.05, 0.27, 5.0, 2.5, 1)
    )
    assert [finding for finding in findings if finding.problem] == []


def test_a_class_without_a_step_and_one_that_is_not_there(installed):
    installed("idle_people", "class Idle:\n    def __init__(self, setup):\n        pass\n")
    for name, error in (
        ("idle_people:Idle", "expected an object with a method step"),
        ("idle_people:Nobody", "cannot be imported"),
        ("nobody_has.it:This", "no installed package has the module"),
    ):
        with pytest.raises((ControlError, CrowdError), match=error):
            giveway.run({"crowd.model": name, "crowd.pedestrians": 3, **SHORT})


def test_a_study_that_names_a_class_is_rerun_with_the_users_word(shy, study_of, tmp_path):
    text = """
name = "named"
replications = 1
[run]
controller = "pid-tuned"
time_limit = 0.5
crowd = { pedestrians = 3 }
[factors]
"crowd.model" = ["shy_people:Shy", "vci"]
"""
    folder = StudyFolder.open(study_of(text, tmp_path / "study").path)
    with pytest.raises(ConfigError, match="--trust shy_people:Shy"):
        checked_run(folder, "c1-s1")
    assert checked_run(folder, "c1-s1", trusted=["shy_people:Shy"])
    assert checked_run(folder, "c2-s1")


def test_a_crowd_without_egos_depends_on_its_model_only(shy, installed):
    """Runs that one process makes with the same people share it."""
    installed("idle_driver", "class Idle:\n    def control(self, seen):\n        return 0.0\n")
    crowd = Crowd.create([[0.0, 0.0]], [[0.0, 0.0]], 1.3, [[[5.0, 0.0]]])

    def key(**settings):
        began = Beginning(crowd, ("ped0",), {})
        return counterfactual._key(RunConfig.model_validate(settings), began, 0.05)

    assert key(controller="idle_driver:Idle") == key(controller="mpc")
    theirs = {"crowd": {"model": "shy"}}
    assert key(controller="idle_driver:Idle", **theirs) == key(**theirs) != key()
    assert key(**theirs, model_options={"look": 3.0}) != key(**theirs)
    before = key(**theirs)
    shy.write_text(shy.read_text(encoding="utf-8") + "# other\n", encoding="utf-8")
    assert key(**theirs) != before
