"""Studies whose runs have twins: what they keep, however they are computed."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import psutil
import pytest

from giveway.cosimulation.counterfactual import counterfactual
from giveway.studies.design import design
from giveway.studies.repeated_run import rerun
from giveway.studies.statistics.fronts import fronts
from giveway.studies.study import StudyInterruptedError

TEXT = """
name = "twins"
replications = 3
[run]
scenario = "shared_space"
twin = true
[factors]
"crowd.pedestrians" = [6, 8]
controller = ["pid-tuned", "pid-paper"]
[comparison]
minimum_pairs = 3
resamples = 99
"""
TABLES = ("runs", "cells", "levels", "fronts", "comparison", "situations", "failures")


@pytest.fixture(scope="module")
def study(study_of, tmp_path_factory):
    return study_of(TEXT, tmp_path_factory.mktemp("study") / "twins")


def bytes_of(path):
    return {name: (path / f"{name}.csv").read_bytes() for name in TABLES}


def test_levels_are_means_of_runs_and_runs_of_their_people(study):
    runs, levels = study.runs, study.levels
    for metric in ("people_delay", "mean_people_delay", "share_gave_way"):
        for cell in study.design.cells:
            own = runs.loc[runs["cell"] == cell.number, metric].to_numpy()
            here = levels["metric"] == metric
            for name, level in cell.levels.items():
                here &= levels[name] == level.value
            (row,) = levels[here].to_dict("records")
            assert row["mean"] == pytest.approx(np.nanmean(own), abs=1e-5)
            assert row["n"] == np.isfinite(own).sum()
    assert (runs["people_delayed"] == runs["crowd.pedestrians"]).all()
    mean = runs["people_delay"] / runs["people_delayed"]
    np.testing.assert_allclose(runs["mean_people_delay"], mean, atol=1e-6)


def test_what_the_twins_took_is_kept(study):
    frame = study.execution
    assert (frame["twin"] > 0.0).all()
    assert (frame["twin"] < frame["seconds"]).all()
    assert (study.computing["twin"] > 0.0).all()


def test_an_interrupted_study_with_twins_resumes_to_equal_bytes(study, study_of, tmp_path):
    def interrupt(progress):
        if progress.made == 5:
            raise KeyboardInterrupt

    with pytest.raises(StudyInterruptedError, match="5 of 12 runs are kept"):
        study_of(TEXT, tmp_path / "half", interrupt)
    counterfactual._alone.clear()  # as in another process
    whole = study_of(TEXT, tmp_path / "half", resume=True)
    assert bytes_of(whole.path) == bytes_of(study.path)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL")
def test_workers_killed_amid_runs_and_twins_change_no_bytes(study, tmp_path):
    file, out = tmp_path / "twins.toml", tmp_path / "out"
    file.write_text(TEXT, encoding="utf-8")
    command = [sys.executable, "-m", "giveway", "study", str(file), "--out", str(out)]
    child = subprocess.Popen([*command, "--quiet", "--no-report", "--jobs", "2"])
    killed, deadline = 0, time.monotonic() + 120.0
    while child.poll() is None:
        assert time.monotonic() < deadline
        made = len(list(out.glob("records/*/*.json")))
        workers = [c for c in psutil.Process(child.pid).children(recursive=True) if _works(c)]
        if workers and killed < 2 and made > 3 * killed:
            workers[killed % len(workers)].kill()
            killed += 1
        time.sleep(0.05)  # each look at all processes takes as long
    assert child.returncode == 0
    assert killed
    assert bytes_of(out) == bytes_of(study.path)


def _works(process):
    """Whether a process has been at work for a while: amid a run, or amid its twin."""
    try:
        return not process.children() and sum(process.cpu_times()[:2]) > 0.2
    except psutil.Error:
        return False


def test_a_run_made_again_has_the_studys_delays(study, tmp_path):
    result = rerun(study, "c1-s2")
    row = study.runs[study.runs["run"] == "c1-s2"].iloc[0]
    assert result.summary["people_delay"] == pytest.approx(row["people_delay"], abs=1e-6)


def test_a_study_without_twins_has_no_fronts(small_study):
    assert small_study.fronts.empty
    assert not (small_study.path / "fronts.csv").exists()
    assert small_study.runs["people_delay"].isna().all()


def test_cells_with_the_same_people_share_the_crowd_among_itself(study_of, tmp_path, monkeypatch):
    made = []
    build = counterfactual.CrowdAlone

    def counted(*arguments):
        made.append(arguments)
        return build(*arguments)

    counterfactual._alone.clear()
    monkeypatch.setattr(counterfactual, "CrowdAlone", counted)
    study_of(TEXT, tmp_path / "shared")
    assert len(made) == 2 * 3  # crowds and seeds; not controllers
    assert len(counterfactual._alone) <= counterfactual._KEPT


def test_who_did_not_always_arrive_is_on_no_front(study):
    levels = study.levels.copy()
    fast = (levels["controller"] == "pid-paper") & (levels["metric"] == "completion_time")
    levels.loc[fast, ["n", "mean"]] = 2, 1.0
    frame = fronts(levels, design(study.definition, "study.toml"), study.definition.comparison)
    assert frame.loc[frame["controller"] == "pid-tuned", "front"].all()
    assert not frame.loc[frame["controller"] == "pid-paper", "front"].any()
