"""A controller FMU drives: our own export as our controller does, others by their profiles."""

from __future__ import annotations

import importlib.util
import json
import shutil
import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import psutil
import pytest
from support.priority import NO_PRIORITY

import giveway
from fmus import ControllerParameters, export_controller
from giveway.config.files.layers import read_toml
from giveway.config.files.loading import load
from giveway.errors import ConfigError, ControlError
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.repeated_run import checked_run

if TYPE_CHECKING:
    from pathlib import Path

MOTION = ["time", "position", "x", "y", "angle", "speed", "acceleration"]
LIKE_THE_PAPER = {
    "safety.enabled": False,
    "rules": NO_PRIORITY,
    "perception.tracker": False,
    "crowd.preset": "SIM",
    "perception.preset": "SIM",
}
SHORT: dict[str, Any] = {"time_limit": 3.0, "crowd": {"pedestrians": 3}}
HEADWAY = """
[inputs.speed]
variable = "v"
unit = "m/s"

[inputs.gap]
variable = "gap"
unit = "m"

[inputs.speed_limit]
variable = "limit"
unit = "m/s"

[outputs.acceleration]
variable = "a_set"
unit = "m/s2"

[setup.reference_speed]
variable = "cruise"
unit = "m/s"
"""
AHEAD = """
[inputs.speed]
variable = "speed"

[inputs.last_force]
variable = "last"

[inputs.obstacle_gaps]
variable = "ahead#"

[outputs.speed]
variable = "wanted"
lead = 0.8

[setup.reference_speed]
variable = "cruise"
"""


@pytest.fixture
def headway(zoo, tmp_path) -> dict[str, Any]:
    """A controller that somebody has written in Python, with its profile."""
    if importlib.util.find_spec("pythonfmu") is None:
        pytest.skip("pip install pythonfmu")
    fmu, profile = tmp_path / "headway.fmu", tmp_path / "headway.toml"
    shutil.copy(zoo.python_controller("2.0"), fmu)
    profile.write_text(HEADWAY, encoding="utf-8")
    return {"controller": str(fmu), "controller_profile": str(profile)}


@pytest.mark.parametrize(
    ("fmi", "controller", "seed", "pedestrians"),
    [("2.0", "mpc-paper", 3, 30), ("3.0", "mpc-paper", 8, 20), ("2.0", "pid-paper", 5, 20)],
)
def test_our_export_drives_as_our_controller(tmp_path, fmi, controller, seed, pedestrians):
    parameters = ControllerParameters(mpc=controller == "mpc-paper")
    fmu = export_controller(tmp_path / "own.fmu", parameters, fmi_version=fmi)
    run = {"crowd.pedestrians": pedestrians, "seed": seed}
    ours = giveway.run({**run, "controller": controller}, results=tmp_path / "a", pictures=False)
    theirs = giveway.run(
        {**run, "controller": str(fmu), **LIKE_THE_PAPER}, results=tmp_path / "b", pictures=False
    )
    a, b = (pd.read_csv(tmp_path / name / "ego.csv", dtype=str) for name in "ab")
    pd.testing.assert_frame_equal(a[MOTION], b[MOTION])
    assert len(a) > 200
    assert set(b["controller"]) == {"plug-in"}
    apart = np.abs(ours.egos[0].track.force - theirs.egos[0].track.force)
    assert apart.max() < 1e-4  # [N] OSQP's tolerance where a plan lies on the force limit


def test_somebody_elses_fmu_drives_by_its_profile(headway, tmp_path):
    out = tmp_path / "run"
    settings = {**headway, "controller_options": {"headway": 3.0}, **SHORT}
    settings |= {"regulation": {"reference_speed": 2.5}, "ego": {"initial_speed": 0.0}}
    result = giveway.run(settings, results=out, pictures=False)
    track = result.egos[0].track
    # v' = (v_r - v) / 0.8 s, at most 1.5 m/s2: the FMU decides on what it is told in the same step
    speed = 0.0
    for found in track.speed[:20]:
        assert found == pytest.approx(speed, abs=1e-9)
        speed += 0.05 * min(1.5, (2.5 - speed) / 0.8)
    told = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["controllers"]["ego"]
    assert told["options"] == {"headway": 3.0}
    assert told["profile"]["outputs"]["acceleration"]["variable"] == "a_set"
    assert len(told["sha256"]) == 64
    assert result.summary["controller"] == "headway.fmu headway=3.0"


def test_units_series_and_speeds(zoo, tmp_path):
    if importlib.util.find_spec("pythonfmu3") is None:
        pytest.skip("pip install pythonfmu3")
    profile = tmp_path / "ahead.toml"
    profile.write_text(AHEAD, encoding="utf-8")
    settings = {
        "controller": str(zoo.python_controller("3.0")),
        "controller_profile": str(profile),
        "crowd": {"pedestrians": 20, "preset": "SIM"},
        "seed": 3,
        "safety": {"enabled": False},
        "time_limit": 12.0,
    }
    track = giveway.run(settings).egos[0].track
    free = np.isinf(track.gap)
    assert free[:40].all()
    assert track.speed[39] == pytest.approx(4.0)  # 14.4 km/h
    assert track.speed.min() < 1.0  # somebody was foreseen


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (1, "returned Acceleration(value=nan, reason=''): expected a finite number [m/s^2]"),
        (2, "no step from 1 s to 1.05 s: the FMU returned 'fatal'"),
        (3, "no answer within 2 s at 1 s of its time; killed; if it is only slow, add `step_tim"),
        (4, "the FMU's process ended itself: exit(3) was called at 1 s of its time"),
    ],
)
def test_a_fault_ends_the_run_with_one_line_and_keeps_its_rows(headway, tmp_path, fault, said):
    profile = tmp_path / "headway.toml"
    profile.write_text(HEADWAY + "[fmu]\nstep_timeout = 2\n", encoding="utf-8")
    before = set(psutil.Process().children(recursive=True))
    with pytest.raises(ControlError) as caught:
        giveway.run(
            {**headway, "controller_options": {"fault": fault}, **SHORT},
            results=tmp_path / "run",
            pictures=False,
        )
    line = str(caught.value)
    assert line.startswith("controller at step 20: 'headway.fmu' of 'ego'")
    assert said in line
    assert line.isprintable()
    assert len(pd.read_csv(tmp_path / "run" / "ego.csv")) == 20
    assert set(psutil.Process().children(recursive=True)) <= before


WRONG = {
    'variable = "v"': ('variable = "vv"', "[inputs.speed] no variable 'vv' in the FMU; did you"),
    'unit = "m/s2"': ('unit = "kg"', "[outputs.acceleration] variable 'a_set' is in 'kg', a mass"),
    '[inputs.gap]\nvariable = "gap"\nunit = "m"': (
        '[inputs.gap]\nvariable = "gap"',
        "[inputs.gap] variable 'gap' has no unit; add the line unit = \"m\"",
    ),
    "[inputs.gap]": ("[inputs.gapp]", "[inputs] gapp: unknown key; docs/controller_fmu.md"),
    "[outputs.acceleration]": ("[outputs.torque]", "[outputs] torque: unknown key"),
    'variable = "cruise"': ('variable = "a_set"', "is output and cannot be set before the start"),
}


@pytest.mark.parametrize("line", WRONG)
def test_a_profile_that_does_not_fit_is_refused_before_the_run(headway, tmp_path, type_here, line):
    wrong, said = WRONG[line]
    profile = tmp_path / "wrong.toml"
    profile.write_text(HEADWAY.replace(line, wrong), encoding="utf-8")
    out = tmp_path / "out"
    words = ["--controller", headway["controller"], "--controller-profile", profile]
    done = type_here("run", *words, "--out", out, "-q")
    assert done.returncode == 2
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not out.exists()


def test_without_a_profile_what_is_open_is_asked(headway, type_here):
    done = type_here("run", "--controller", headway["controller"], "-q")
    assert done.returncode == 2
    assert "needs a controller profile (--controller-profile FILE.toml)" in done.stderr
    assert "'limit'" in done.stderr


def test_a_profile_belongs_to_an_fmu(headway, tmp_path):
    profile = headway["controller_profile"]
    with pytest.raises(ConfigError, match="'mpc' is no controller FMU"):
        giveway.run({"controller_profile": profile})
    file = tmp_path / "run.toml"
    file.write_text('controller = "headway.fmu"\ncontroller_profile = "headway.toml"\n', "utf-8")
    config, _ = load([read_toml(file)])
    assert (config.controller, config.controller_profile) == tuple(headway.values())
    other, _ = load([read_toml(file), read_toml(_written(tmp_path, 'controller = "mpc"\n'))])
    assert other.controller_profile == ""  # left behind


def test_a_results_folder_needs_consent_and_the_same_content(headway, tmp_path, type_here):
    out, fmu = tmp_path / "results", headway["controller"]
    giveway.run({**headway, **SHORT, "time_limit": 0.3}, results=out, pictures=False)
    words = ["run", "--config", out / "config.toml", "--out", tmp_path / "again", "-q"]
    refused = type_here(*words)
    assert refused.returncode == 2
    assert "a results folder names code" in refused.stderr
    assert type_here(*words, "--controller", fmu).returncode == 0
    with open(fmu, "ab") as file:  # noqa: PTH123 - a text
        file.write(b"\0")
    refused = type_here(*words, "--controller", fmu)
    assert refused.returncode == 2
    assert "the results were made with another content of this file" in refused.stderr


STUDY = """
name = "fmu"
replications = 2

[run]
time_limit = 1.5
crowd.pedestrians = 3

[factors.driver.sound]
controller = "headway.fmu"
controller_profile = "headway.toml"

[factors.driver.broken]
controller = "headway.fmu"
controller_profile = "headway.toml"
controller_options = { fault = 2 }
"""


def test_a_study_records_a_fault_and_notices_another_content(headway, tmp_path, type_here):
    file, out = tmp_path / "study.toml", tmp_path / "study"
    file.write_text(STUDY, encoding="utf-8")
    done = type_here("study", file, "--out", out, "--no-report", "-q")
    assert done.returncode == 1
    failures = pd.read_csv(out / "failures.csv")
    assert len(failures) == 2
    assert failures["cause"].str.contains("the FMU returned 'fatal'").all()
    study = StudyFolder.open(out)
    with pytest.raises(ConfigError, match="--trust"):
        checked_run(study, "c1-s1")
    checked_run(study, "c1-s1", trusted=[headway["controller"]])
    again = type_here("study", file, "--out", out, "--no-report", "--resume")
    assert "2 run(s) made" in again.stdout or "made" in again.stdout
    with open(headway["controller"], "ab") as archive:  # noqa: PTH123 - a text
        archive.write(b"\0")
    with pytest.raises(ConfigError, match="another content"):
        checked_run(study, "c1-s1", trusted=[headway["controller"]])


def test_the_conformance_kit_takes_it(headway, type_here):
    words = [headway["controller"], "--controller-profile", headway["controller_profile"]]
    done = type_here("check", "controller", *words)
    assert "headway.fmu: sound" in done.stdout, done.stdout


def _written(folder: Path, text: str) -> Path:
    file = folder / "other.toml"
    file.write_text(text, encoding="utf-8")
    assert tomllib.loads(text)
    return file
