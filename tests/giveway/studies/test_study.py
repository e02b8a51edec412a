"""A study as a whole: its tables, its folder, how it stops."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import psutil
import pytest

from giveway.errors import GivewayError, ResultsError
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.plan import plan
from giveway.studies.repeated_run import rerun
from giveway.studies.study import StudyOptions, run_study


def test_runs_csv_has_a_row_per_run_and_the_summarys_numbers(small_study):
    runs = pd.read_csv(small_study.path / "runs.csv", dtype={"ego": str})
    assert list(runs["run"]) == [f"c{c}-s{s}" for c in range(1, 5) for s in range(1, 6)]
    import giveway

    crowd = {"pedestrians": 2, "preset": "MIXED"}  # as in the runs of the other controller
    settings = {"controller": "pid", "crowd": crowd, "seed": 4, "time_limit": 2.0}
    alone = giveway.run(settings).summary
    row = runs[runs["run"] == "c4-s4"].iloc[0]
    assert row["controller"] == "pid"
    assert row["crowd.pedestrians"] == 2
    for name in ("travelled_distance", "mean_speed", "minimum_clearance", "rms_jerk"):
        assert row[name] == pytest.approx(alone[name], abs=5e-7)


def test_pairs_meet_the_same_crowd(small_study):
    """Until the ego reacts, nothing but the controller differs."""
    mpc, pid = (rerun(small_study, f"c{cell}-s3") for cell in (1, 2))
    assert mpc.config.controller != pid.config.controller
    first = [(r.crowd_track.x[:3].tolist(), r.crowd_track.y[:3].tolist()) for r in (mpc, pid)]
    assert first[0] == first[1]


def test_comparison_csv_holds_the_mean_of_the_paired_differences(small_study):
    runs = pd.read_csv(small_study.path / "runs.csv", dtype={"ego": str})
    comparison = pd.read_csv(small_study.path / "comparison.csv")
    row = comparison.query(
        "`crowd.pedestrians` == 3 and situation == 'general' and metric == 'mean_speed'"
    ).iloc[0]
    chosen = runs[runs["crowd.pedestrians"] == 3].pivot_table(
        index="seed", columns="controller", values="mean_speed"
    )
    assert row["mean_difference"] == pytest.approx((chosen["mpc"] - chosen["pid"]).mean(), abs=1e-6)
    assert row["n"] == 5


def test_every_table_is_described_by_the_data_package(small_study):
    import json

    package = json.loads((small_study.path / "datapackage.json").read_text(encoding="utf-8"))
    for resource in package["resources"]:
        header = (small_study.path / resource["path"]).read_text(encoding="utf-8").splitlines()[0]
        names = [field["name"] for field in resource["schema"]["fields"]]
        assert header.split(",") == names
        assert all(field["description"] for field in resource["schema"]["fields"])
    assert {r["name"] for r in package["resources"]} == {
        path.stem for path in small_study.path.glob("*.csv")
    }


def test_two_workers_of_which_one_freezes_do_not_matter(
    small_study, study_of, small_study_text, tables_of, tmp_path, capsys
):
    def freeze(progress):
        if progress.made == 3:
            psutil.Process(int(progress.latest.computing.worker.rpartition(":")[2])).suspend()

    two = study_of(small_study_text, tmp_path / "two", freeze, jobs=2, hang_limit=2.0)
    assert tables_of(two.path) == tables_of(small_study.path)
    told = r"note: c\d-s\d: no progress for 2.* s .*; another process has made it"
    assert re.search(told, capsys.readouterr().err)


def test_failed_runs_are_listed_with_the_command_to_repeat_them(study_of, tmp_path):
    """An ego that the scenario never lets depart."""
    text = """
        name = "lost"
        replications = 2
        [run.ego]
        depart_position = 1.0
        [factors.where]
        "on the road" = { time_limit = 0.5 }
        "nowhere" = { ego = { take_over = ["nobody"] } }
    """
    study = study_of(text, tmp_path / "lost")
    failures = pd.read_csv(study.path / "failures.csv")
    assert list(failures["run"]) == ["c2-s1", "c2-s2"]
    assert failures["cause"].str.contains("nobody").all()
    assert failures["reproduce"].iloc[0] == f"giveway rerun {study.path} c2-s1"
    runs = pd.read_csv(study.path / "runs.csv")
    assert list(runs["ending"]) == ["time limit"] * 2 + ["failed"] * 2
    assert runs["travelled_distance"].notna().tolist() == [True, True, False, False]
    states = []
    study_of(text, study.path, states.append, resume=True)
    assert states[-1].made == 0
    study_of(text, study.path, states.append, resume=True, retry_failed=True)
    assert states[-1].made == 2


def test_what_is_read_back_is_what_was_computed(small_study, tmp_path):
    import shutil

    folder = shutil.copytree(small_study.path, tmp_path / "copy")
    kept = StudyFolder.open(folder).comparison
    (folder / "comparison.csv").unlink()
    pd.testing.assert_frame_equal(kept, StudyFolder.open(folder).comparison, check_dtype=False)


def test_a_folder_without_a_study(tmp_path):
    with pytest.raises(ResultsError, match="no study there"):
        StudyFolder.open(tmp_path)


def test_seeds_are_added_until_the_interval_is_narrow(study_of, tmp_path):
    text = """
        name = "narrow"
        replications = 60
        [run]
        time_limit = 1.0
        crowd.pedestrians = 1
        [factors]
        controller = ["mpc", "pid"]
        [comparison]
        minimum_pairs = 5
        resamples = 199
        [precision]
        metric = "mean_speed"
        width = WIDTH
        minimum = 10
        batch = 10
    """
    wide = study_of(text.replace("WIDTH", "1.0"), tmp_path / "wide")
    assert len(wide.runs) == 20  # enough at the first look
    narrow = study_of(text.replace("WIDTH", "1e-12"), tmp_path / "narrow")
    assert len(narrow.runs) in {20, 120}  # 20 only if nothing varies at all
    assert narrow.planned == len(narrow.runs)


def test_the_order_of_the_runs_keeps_pairs_together(small_study):
    planned = plan(small_study.definition, "s")
    order = [run.id for run in planned.runs(planned.seeds)]
    assert order[:4] == ["c1-s1", "c2-s1", "c3-s1", "c4-s1"]


def test_an_unusable_number_of_jobs_is_refused(study_of, small_study_text, tmp_path):
    with pytest.raises(GivewayError):
        run_study(
            _definition(small_study_text),
            "s",
            tmp_path / "x",
            StudyOptions(hang_limit=-1.0, jobs=1),
        )


def _definition(text):
    from giveway.studies.definition import parse_definition

    return parse_definition(text, "s", Path())
