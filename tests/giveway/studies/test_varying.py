"""Studies without a file, from the command line and from Python."""

from __future__ import annotations

import pytest

import giveway
from giveway.errors import ConfigError
from giveway.studies.definition import make_definition
from giveway.studies.design import design
from giveway.studies.varying import chosen, varied


def test_variations_are_a_grid_of_their_values():
    found = varied(["controller_options.precaution_weight=5, 20", "controller=mpc,pid-tuned"])
    assert found.factors == {
        "controller_options.precaution_weight": [5, 20],
        "controller": ["mpc", "pid-tuned"],
    }
    assert found.name == "vary_controller_options.precaution_weight_controller"
    assert found.replications == 20


@pytest.mark.parametrize("wrong", ["crowd.pedestrians", "crowd.pedestrians=5", "=1,2", "a=,,"])
def test_what_is_no_variation_is_said(wrong):
    with pytest.raises(ConfigError, match="expected an option and at least two values"):
        varied([wrong])


def test_an_option_that_is_named_twice_is_refused():
    with pytest.raises(ConfigError, match="--vary seed: is given twice"):
        varied(["seed=1,2", "seed=3,4"])


def test_other_settings_come_from_a_file(tmp_path):
    (tmp_path / "run.toml").write_text("time_limit = 2.0\n[crowd]\npedestrians = 3\n")
    found = varied(["controller=mpc,pid-tuned"], tmp_path / "run.toml")
    assert found.run == {"time_limit": 2.0, "crowd": {"pedestrians": 3}}


def test_a_study_from_python_gives_frames(tmp_path):
    study = giveway.study(
        {
            "factors": {"controller": ["mpc", "pid-tuned"]},
            "replications": 2,
            "run": {"crowd.pedestrians": 2, "time_limit": 1.0},
        },
        out=tmp_path / "study",
        jobs=1,
    )
    assert len(study.runs) == 4
    assert set(study.levels["controller"]) == {"mpc", "pid-tuned"}
    assert (study.comparison["n"] <= 2).all()
    assert repr(study).endswith("2 cells, 4 of 4 runs>")


DRIVERS = {
    "name": "drivers",
    "factors": {
        "crowd": {"pedestrians": [10, 20, 30]},
        "controller": ["mpc", "pid-tuned"],
    },
}


def labels(values):
    return [cell.label for cell in design(make_definition(values, "s"), "s").cells]


def test_some_levels_of_a_study_are_its_cells_in_the_same_order():
    only = chosen(["controller=mpc", "crowd.pedestrians=30", "crowd.pedestrians=10"])
    assert labels(DRIVERS | {"only": only}) == [
        "crowd.pedestrians = 10, controller = mpc",
        "crowd.pedestrians = 30, controller = mpc",
    ]


def test_cells_that_are_listed_are_chosen_from_too():
    cells = [
        {"crowd": {"pedestrians": number}, "controller": name}
        for number, name in ((10, "mpc"), (20, "mpc"), (10, "pid-tuned"))
    ]
    found = labels(DRIVERS | {"cells": cells, "only": {"controller": ["mpc"]}})
    assert found == [
        "crowd.pedestrians = 10, controller = mpc",
        "crowd.pedestrians = 20, controller = mpc",
    ]


@pytest.mark.parametrize(
    ("only", "words"),
    [
        ({"driver": ["mpc"]}, "only driver: not a factor of this study; expected one of crowd"),
        ({"controller": ["idm"]}, "only controller = idm: expected one of mpc; pid-tuned"),
    ],
)
def test_a_level_that_the_study_does_not_have_is_said(only, words):
    with pytest.raises(ConfigError, match=words):
        labels(DRIVERS | {"only": only})


@pytest.mark.parametrize("wrong", ["controller", "=mpc", "controller="])
def test_what_chooses_nothing_is_said(wrong):
    with pytest.raises(ConfigError, match="expected a factor of the study and one of its levels"):
        chosen([wrong])


def test_a_part_of_a_bundled_study_runs_without_its_baseline(type_here, tmp_path):
    words = ("study", "controllers", "--only", "controller=mpc", "--only", "scene=one-sided, 10")
    done = type_here(*words, "--runs", 1, "--no-twin", "--no-report", "--jobs", 1, "--out", "out")
    assert done.returncode == 0, done.stderr
    runs = (tmp_path / "out" / "runs.csv").read_text().splitlines()
    assert len(runs) == 2


def test_the_command_line_takes_variations(type_here, tmp_path):
    (tmp_path / "run.toml").write_text("time_limit = 0.5\n[crowd]\npedestrians = 2\n")
    words = ("study", "--vary", "controller=mpc,pid-tuned", "--config", "run.toml", "--seeds", 1)
    done = type_here(*words, "--no-report", "--jobs", 1, "--out", "out")
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "out").glob("runs.csv"))) == 1
    for wrong in ((), ("paper", *words[1:3]), ("paper", "--config", "run.toml")):
        done = type_here("study", *wrong)
        assert done.returncode == 2
        assert done.stderr.startswith("error: expected a study, or --vary")
