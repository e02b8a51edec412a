"""A risk as a whole: its tables, how it goes on, and that a run of it can be made again."""

from __future__ import annotations

import math
import re
from copy import copy
from dataclasses import replace

import pandas as pd
import pytest

from giveway.errors import GivewayError, ResultsError
from giveway.replays.run_folder import RunFolder
from giveway.reports.with_replays import write_report_of_risk
from giveway.risk.risk_folder import RiskFolder
from giveway.risk.severity import rosen_sander
from giveway.risk.tables import per_kilometre
from giveway.studies.folder.examination import examine_results
from giveway.studies.folder.lock import RISK_TABLES
from giveway.studies.repeated_run import rerun
from giveway.studies.study import StudyInterruptedError
from giveway.studies.study_options import StudyOptions


def tables_of(folder):
    return {name: (folder / f"{name}.csv").read_bytes() for name in RISK_TABLES}


def test_the_tables_hold_the_estimate_and_every_run(small_risk):
    estimate = small_risk.estimate
    risk = pd.read_csv(small_risk.path / "risk.csv").iloc[0]
    assert risk["probability"] == pytest.approx(estimate.events / 8)
    assert risk["low"] <= risk["probability"] <= risk["high"]
    assert risk["per_km"] == pytest.approx(risk["probability"] / risk["distance"], rel=1e-4)
    runs = pd.read_csv(small_risk.path / "runs.csv")
    assert list(runs["run"]) == [f"r{number}" for number in range(1, 9)]
    assert runs["vehicle.mass"].nunique() == 8
    assert 0 < estimate.events < 8


def test_no_distance_is_known_where_all_runs_are_drawn_near_the_event(small_risk):
    definition = small_risk.plan.definition.model_copy(update={"method": "importance"})
    drawn = copy(small_risk)
    drawn.plan = replace(small_risk.plan, definition=definition)
    told = per_kilometre(drawn, small_risk.estimate)
    assert math.isnan(told.distance)
    assert math.isnan(told.high)


def test_the_runs_with_the_event_are_listed_the_worst_first(small_risk):
    events = pd.read_csv(small_risk.path / "events.csv")
    assert len(events) == small_risk.estimate.events
    assert events["criticality"].is_monotonic_decreasing
    assert events["criticality"].tolist() == events["frontal_impact_speed"].tolist()
    assert events["reproduce"].str.startswith("giveway rerun ").all()


def test_the_severity_by_the_default_curve_is_known_from_plain_runs(small_risk):
    severity = pd.read_csv(small_risk.path / "severity.csv").iloc[0]
    speeds = pd.read_csv(small_risk.path / "events.csv")["frontal_impact_speed"]
    risks = [rosen_sander(3.6 * speed) for speed in speeds]
    assert severity["impacts"] == severity["valid"] == len(speeds)
    assert severity["mean"] == pytest.approx(sum(risks) / len(risks), rel=1e-4)
    assert severity["in_a_run"] == pytest.approx(sum(risks) / 8, rel=1e-4)
    assert severity["low"] < severity["in_a_run"] < severity["high"]


def test_a_run_can_be_made_again_with_the_same_numbers(small_risk):
    event = pd.read_csv(small_risk.path / "events.csv").iloc[0]
    result = rerun(RiskFolder(small_risk.path), event["run"])
    assert result.summary["frontal_impact_speed"] == pytest.approx(event["frontal_impact_speed"])
    with pytest.raises(ResultsError, match=r"run 'r9': not in .* expected r<number>, r1 to r8"):
        RiskFolder(small_risk.path).record("r9")


def test_a_risk_that_was_ended_goes_on_with_the_same_bytes(small_risk, risk_of, resumed, tmp_path):
    def end(progress):
        if progress.made == 3:
            raise KeyboardInterrupt

    out = tmp_path / "ended"
    with pytest.raises(StudyInterruptedError, match=r"3 runs are kept in .* go on with --resume"):
        risk_of(out, watcher=end)
    made = []
    risk_of(out, resumed, lambda progress: made.append(progress.made))
    assert max(made) == 5
    assert tables_of(out) == tables_of(small_risk.path) | {
        name: tables_of(small_risk.path)[name].replace(
            str(small_risk.path).encode(), str(out).encode()
        )
        for name in ("events", "likeliest")
    }


def test_two_workers_give_the_same_bytes(small_risk, risk_of, tmp_path):
    two = risk_of(tmp_path / "two", StudyOptions(jobs=2))
    assert tables_of(two.path)["runs"] == tables_of(small_risk.path)["runs"]
    assert tables_of(two.path)["risk"] == tables_of(small_risk.path)["risk"]


def test_more_runs_need_only_the_new_ones(small_risk, risk_of, resumed, tmp_path):
    out = tmp_path / "more"
    risk_of(out, runs=2)
    made = []
    more = risk_of(out, resumed, lambda progress: made.append(progress.made), runs=4)
    assert max(made) == 2
    assert [run.id for run, _ in more.runs] == ["r1", "r2", "r3", "r4"]


def test_sobol_indices_cost_further_runs_that_leave_the_estimate_alone(
    small_risk, risk_of, resumed, tmp_path
):
    out = tmp_path / "why"
    risk_of(out)
    made = []
    folder = risk_of(out, resumed, lambda progress: made.append(progress.made), why=4)
    assert max(made) == 4 * (3 + 2)
    assert folder.estimate == small_risk.estimate
    why = pd.read_csv(out / "why.csv")
    assert list(why["group"]) == ["noise", "vehicle.mass", "crowd"]
    assert (why["used"] == 4).all()
    assert len(pd.read_csv(out / "runs.csv")) == 8
    assert folder.record("r28") is not None


def test_another_folder_is_not_taken_for_a_risk(small_risk, risk_of, tmp_path):
    with pytest.raises(ResultsError, match="no risk there"):
        RiskFolder(tmp_path)
    with pytest.raises(GivewayError, match="go on with it by --resume"):
        risk_of(small_risk.path)


def test_the_report_plays_the_likeliest_runs_with_the_event(small_risk):
    page = write_report_of_risk(RiskFolder(small_risk.path)).read_text("utf-8")
    shown = re.findall(r'href="(replays/r\d+\.html)"', page)
    assert len(set(shown)) == min(10, small_risk.estimate.events)
    assert all((small_risk.path / link).is_file() for link in shown)


def test_a_finished_risk_is_told_from_one_that_is_under_way(small_risk, risk_of, tmp_path):
    (whole,) = examine_results(small_risk.path)
    assert (whole.level, whole.text) == (
        "ok",
        f"{small_risk.path}: as the risk wrote them, 8 runs",
    )

    def end(progress):
        raise KeyboardInterrupt

    with pytest.raises(StudyInterruptedError):
        risk_of(tmp_path / "ended", watcher=end)
    (part,) = examine_results(tmp_path / "ended")
    assert (part.level, part.remedy) == ("note", "go on with giveway risk and --resume")


def test_a_risk_is_not_played_as_if_it_were_a_run(small_risk):
    with pytest.raises(
        ResultsError, match="a risk with many runs; make one again by giveway rerun"
    ):
        RunFolder.read(small_risk.path)
