"""Somebody else's controller drives: as docs/plugins.md prints it, in runs and studies."""

from __future__ import annotations

import importlib
import json
import shutil
import tomllib
from pathlib import Path

import pandas as pd
import pytest
from support.plug_ins import printed
from support.runs import foreign

import giveway
from giveway.config import EgoRunConfig, RunConfig
from giveway.config.files.layers import Layer, dump_toml, read_toml
from giveway.config.files.loading import load
from giveway.cosimulation.preflight import preflight
from giveway.ego.controllers import make_controller
from giveway.errors import ConfigError
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import checked_run, rerun

SHORT = {"time_limit": 2.0, "crowd": {"pedestrians": 3}}


def test_the_package_is_short():
    assert len(printed("file: careful_driver.py").splitlines()) <= 60


def test_the_guides_shortest_controller_is_sound_and_drives(installed, require_sound_controller):
    points = tomllib.loads(printed("file: gentle pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points["giveway.controllers"].items()
    installed("gentle", printed("file: gentle.py"), declares=f"{name} = {value}")
    result = giveway.run({"scenario": "encounter", "controller": name, "time_limit": 4.0})
    assert 0.0 < result.egos[0].track.speed[-1] < 2.1
    require_sound_controller(importlib.import_module("gentle").Gentle)


def test_the_guides_controller_drives_as_its_settings_say(careful, tmp_path):
    file = tmp_path / "careful.toml"
    file.write_text(printed("run"), encoding="utf-8")
    config, _ = load([read_toml(file)])
    assert config.controller_options == {"headway": 1.5}
    out = tmp_path / "run"
    result = giveway.run({**tomllib.loads(printed("run")), **SHORT}, results=out, pictures=True)
    ego = pd.read_csv(out / "ego.csv")
    assert set(ego["controller"]) <= {"plug-in", "safety"}
    assert "free" in set(ego["reason"])
    assert ego["force"].abs().max() <= 5000.0
    told = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["controllers"]["ego"]
    assert told["distribution"] == "careful-driver"
    assert told["options"] == {"headway": 1.5, "aside": 3.0, "walking_pace": 1.5}
    assert len(told["sha256"]) == 64
    again = giveway.run(out / "config.toml", pictures=False)
    assert (again.egos[0].track.force == result.egos[0].track.force).all()


def test_options_change_the_drive(careful):
    near, far = (
        giveway.run({"controller": "careful", "controller_options.aside": aside, **SHORT})
        for aside in (0.0, 50.0)
    )
    assert "people beside" not in set(near.egos[0].track.reason)
    assert "people beside" in set(far.egos[0].track.reason)
    assert far.egos[0].track.speed[-1] < near.egos[0].track.speed[-1]


def test_the_configuration_as_it_is_written_is_the_configuration(careful):
    config = RunConfig(controller="careful", controller_options={"headway": 3.0})
    assert RunConfig.model_validate(tomllib.loads(dump_toml(config))) == config
    assert RunConfig.model_validate_json(config.model_dump_json()) == config


def test_set_fills_the_options_in(careful, type_here, tmp_path):
    typed = type_here("config", "--controller", "careful", "--set", "headway=1.25")
    assert tomllib.loads(typed.stdout)["controller_options"] == {"headway": 1.25}
    out = tmp_path / "run"
    words = ["run", "--controller", "careful", "--set", "headwy=1", "--out", out, "-q"]
    refused = type_here(*words)
    assert refused.returncode == 2
    assert "headwy: 'careful' has no such option; did you mean 'headway'?" in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1
    assert not out.exists()


@pytest.mark.parametrize("word", ["headway", "=3", "headway=1 headway=2"])
def test_what_set_does_not_take(careful, type_here, word):
    words = [piece for part in word.split(" ") for piece in ("--set", part)]
    typed = type_here("config", "--controller", "careful", *words)
    assert typed.returncode == 2
    assert "--set" in typed.stderr


def test_an_option_is_finite(careful):
    with pytest.raises(ConfigError, match=r"headway = nan: expected a finite number"):
        giveway.run({"controller": "careful", "controller_options.headway": float("nan")})


def test_another_controllers_options_stay_behind(careful, tmp_path, type_here):
    file = tmp_path / "careful.toml"
    file.write_text(printed("run"), encoding="utf-8")
    typed = type_here("config", "--config", file, "--controller", "mpc")
    assert typed.returncode == 0
    assert "controller_options" not in tomllib.loads(typed.stdout)
    two = RunConfig(
        controller="careful",
        controller_options={"headway": 3.0},
        egos=({"ego": {"id": "a"}}, {"controller": "mpc", "ego": {"id": "b"}}),
    )
    assert [ego.controller_options for ego in two.each_ego()] == [{"headway": 3.0}, {}]


def test_an_option_of_another_controller_is_refused():
    with pytest.raises(ConfigError, match="headway: 'mpc' has no such option"):
        giveway.run({"controller": "mpc", "controller_options.headway": 1.0})
    with pytest.raises(ConfigError, match="headway: 'pid-paper' has no such option"):
        giveway.run({"controller": "pid-paper", "controller_options.headway": 1.0})


def test_a_plug_ins_declaration_holds_unless_the_user_sets_it(installed):
    installed(
        "declared_driver",
        "from controller import Defaults\n"
        "class Driver:\n"
        "    defaults = Defaults(3.0, heeds_priority=False, tracker=False, safety_layer=False)\n"
        "    def __init__(self, setup):\n        pass\n"
        "    def control(self, seen):\n        return 0.0\n",
    )
    name = {"controller": "declared_driver:Driver", "scenario": "street"}
    config, _ = load([Layer("mine", name)])
    (ego,) = config.each_ego()
    assert (ego.reference_speed, ego.heeds("crossings")) == (3.0, False)
    assert (ego.tracks_people, ego.safety_layer) == (False, False)
    set_by_user = {"regulation": {"reference_speed": 5.0}, "safety": {"enabled": True}}
    egos = [{"controller": name["controller"], **set_by_user}, {"ego": {"id": "other"}}]
    config, _ = load([Layer("mine", {"scenario": "street", "egos": egos})])
    ours, other = config.each_ego()
    assert (ours.reference_speed, ours.safety_layer, ours.tracks_people) == (5.0, True, False)
    assert (other.reference_speed, other.safety_layer, other.heeds("merging")) == (
        "lane",
        True,
        True,
    )


def test_the_schema_has_declared_options_and_references(careful):
    import jsonschema

    from giveway.cli.commands.schema_command import schemas

    schema = schemas()["giveway-run.schema.json"]
    for name in ("mpc", "careful", "some.package:Class"):
        jsonschema.validate({"controller": name, "controller_options": {"a": 1}}, schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"controller": "carefull"}, schema)


def test_a_name_that_nobody_has(type_here):
    for name in ("mcp", "nobody.has:This"):
        typed = type_here("run", "--controller", name, "-q")
        assert typed.returncode != 0
        assert name in typed.stderr
        assert len(typed.stderr.strip().splitlines()) == 1


def test_a_results_folder_is_not_believed(careful, installed, tmp_path, type_here):
    """What it names is imported with the user's word, or if it is declared and has not changed."""
    for name in ("careful", "careful_driver:Careful"):
        out = tmp_path / name.replace(":", "-")
        giveway.run({"controller": name, "time_limit": 0.2, "crowd.pedestrians": 0}, results=out)
    declared, named = tmp_path / "careful", tmp_path / "careful_driver-Careful"
    config = declared / "config.toml"
    assert load([read_toml(config)])[0].controller == "careful"
    with pytest.raises(ConfigError, match="a results folder names code"):
        load([read_toml(named / "config.toml")])
    assert load([read_toml(named / "config.toml")], trusted={"careful_driver:Careful"})
    words = ["--controller", "careful_driver:Careful"]
    assert type_here("config", "--config", named / "config.toml", *words).returncode == 0
    theirs = foreign(shutil.copytree(declared, tmp_path / "theirs")) / "config.toml"
    with pytest.raises(ConfigError, match="somebody else's results folder names code"):
        load([read_toml(theirs)])
    assert load([read_toml(theirs)], trusted={"careful"})
    elsewhere = shutil.copy(named / "config.toml", tmp_path / "my.toml")
    assert load([read_toml(Path(elsewhere))])  # the user's own file
    careful.write_text(careful.read_text(encoding="utf-8") + "# other\n", encoding="utf-8")
    with pytest.raises(ConfigError, match="made with another content of careful-driver"):
        load([read_toml(config)])
    assert type_here("config", "--config", config, "--controller", "careful").returncode == 0


def test_the_guides_study_is_resumed_with_its_own_settings(careful, study_of, tmp_path):
    text = printed("study").replace("100", "1") + "\n[run]\ntime_limit = 1.0\n"
    text += "crowd = { pedestrians = 3 }\n"
    study = study_of(text, tmp_path / "study")
    assert not len(study.failures)
    assert set(study.runs["driver"]) == {"careful", "mpc"}
    keys = {record.run: record.key for _, _, record in study.records}
    assert rerun(StudyFolder.open(study.path), "c1-s1")
    careful.write_text(careful.read_text(encoding="utf-8") + "# other\n", encoding="utf-8")
    with pytest.raises(ConfigError, match="made with another content of careful-driver"):
        checked_run(StudyFolder.open(study.path), "c1-s1")
    resumed = study_of(text, tmp_path / "study", resume=True)
    again = {record.run: record.key for _, _, record in resumed.records}
    assert again["c2-s1"] == keys["c2-s1"]
    assert again["c1-s1"] != keys["c1-s1"]


def test_a_study_that_names_a_class_is_rerun_with_the_users_word(careful, study_of, tmp_path):
    text = """
name = "named"
replications = 1
[run]
time_limit = 0.5
[factors]
controller = ["careful_driver:Careful", "pid-tuned"]
"""
    study = study_of(text, tmp_path / "study")
    folder = StudyFolder.open(study.path)
    with pytest.raises(ConfigError, match="--trust careful_driver:Careful"):
        checked_run(folder, "c1-s1")
    assert checked_run(folder, "c1-s1", trusted=["careful_driver:Careful"])
    assert checked_run(folder, "c2-s1")


def test_predictions_for_whoever_wants_them(installed):
    installed(
        "far_driver",
        "class Driver:\n"
        "    horizon = 12\n"
        "    def __init__(self, setup):\n        pass\n"
        "    def control(self, seen):\n"
        "        assert seen.obstacle_positions.shape == (12,)\n"
        "        assert len(seen.person_ids) == len(seen.people.position)\n"
        "        assert seen.path.curvature(seen.obstacle_positions[:0]).shape == (0,)\n"
        "        return 0.0\n",
    )
    result = giveway.run({"controller": "far_driver:Driver", **SHORT})
    assert len(result.time) == 41
    own = EgoRunConfig(controller="far_driver:Driver")
    assert make_controller(own, 0.05).horizon == 12
    assert preflight(*load([])).time_step == 0.05
