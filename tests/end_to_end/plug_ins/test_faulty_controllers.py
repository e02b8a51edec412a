"""Somebody else's controller fails: in runs, in studies, and when it is checked."""

from __future__ import annotations

import re

import pandas as pd
import pytest
from support.plug_ins import printed

import giveway
from giveway.cli.commands.check_command import check_command
from giveway.errors import ControlError
from giveway.plug_ins.sockets import CONTROLLER

SHORT = {"time_limit": 2.0, "crowd": {"pedestrians": 3}}
FAULTS = {
    "nan": "returned Acceleration(value=nan, reason=''): expected a finite number [m/s^2]",
    "shape": "returned array([0., 0., 0.]): expected Force, Acceleration or Speed",
    "raise": "raised ValueError: no idea (faulty_driver.py:",
    "leave": "raised SystemExit: 0 (faulty_driver.py:",
}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_ends_the_run_with_one_line_and_keeps_its_rows(faulty, kind, tmp_path):
    settings = {"controller": "broken", "controller_options": {"kind": kind}, **SHORT}
    with pytest.raises(ControlError) as caught:
        giveway.run(settings, results=tmp_path / "run", pictures=False)
    line = str(caught.value)
    assert line.startswith(f"controller at step 20: 'broken' of 'ego' {FAULTS[kind]}")
    assert line.isprintable()
    assert len(pd.read_csv(tmp_path / "run" / "ego.csv")) == 20
    if kind == "nan":
        assert line == printed("failure").strip()


def test_faults_in_a_study_are_a_row_each_beside_sound_runs(faulty, study_of, tmp_path):
    text = """
name = "faults"
replications = 1
[run]
controller = "broken"
time_limit = 2.0
crowd = { pedestrians = 3 }
[factors]
"controller_options.kind" = ["none", "nan", "exit", "hang"]
"""
    study = study_of(text, tmp_path / "study", jobs=1, hang_limit=3.0)
    failures = study.failures.set_index("run")["cause"]
    assert sorted(failures.index) == ["c2-s1", "c3-s1", "c4-s1"]
    assert "controller at step 20: 'broken' of 'ego' returned" in failures["c2-s1"]
    assert re.search(r"exit\(0\) .* in the controller 'broken' at .*step 20", failures["c3-s1"])
    assert re.search(r"no progress .* in the controller 'broken' at .*step 20", failures["c4-s1"])


def test_the_supervisor_names_the_controller_that_ended_the_run(faulty, type_outside, tmp_path):
    words = ["run", "--controller", "faulty_driver:Driver", "--set", "kind=exit", "-q"]
    words += ["--time-limit", 2, "--pedestrians", 3, "--out", tmp_path / "run", "--no-pictures"]
    typed = type_outside(*words)
    assert typed.returncode == 1
    assert "in the controller 'faulty_driver:Driver' at" in typed.stderr
    assert len(pd.read_csv(tmp_path / "run" / "ego.csv")) >= 20


def test_check_says_whether_a_controller_keeps_to_the_rules(careful, faulty, type_here):
    typed = type_here("check", "controller", "careful", "--set", "headway=1.5")
    assert typed.returncode == 0, typed.stdout
    assert "careful: sound" in typed.stdout
    typed = type_here("check", "controller", "broken", "--set", "kind=nan")
    assert typed.returncode == 1
    assert "broken  answers numbers" in typed.stdout
    assert "finite number" in typed.stdout
    assert type_here("check", "controller", "mpc").returncode == 2
    assert "no such option" in type_here("check", "controller", "careful", "--set", "a=1").stderr


@pytest.mark.parametrize(
    ("kind", "said"),
    [("hang", "does not come back: ended after 2 s"), ("exit", "ends the process (exit code 0)")],
)
def test_check_comes_back_from_a_controller_that_does_not(faulty, capsys, kind, said):
    code = check_command("broken", [f"kind={kind}"], CONTROLLER, limit=2.0)
    assert code == 1
    shown = capsys.readouterr().out.splitlines()
    assert shown[:2] == ["kept    can be made", "broken  answers numbers"]
    assert shown[2].strip() == said
    assert shown[3] == "broken: 1 of 2 rules broken"


@pytest.mark.parametrize("step", [None, 0.1])
def test_check_is_in_steps_of_a_run(faulty, capsys, step):
    assert check_command("broken", ["kind=step"], CONTROLLER, time_step=step) == 1
    assert f"steps of {step or 0.05} s" in capsys.readouterr().out
