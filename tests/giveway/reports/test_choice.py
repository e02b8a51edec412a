"""The metrics that a report chooses."""

from __future__ import annotations

from dataclasses import replace

import pandas as pd
import pytest

from giveway.reports.choice import example_pairs, worst_runs


class TestChoice:
    """Which runs are shown, from the frames alone."""

    def test_the_run_with_most_close_passes_comes_first(self, study):
        first, *others = worst_runs(study, 3)
        assert first.value == study.runs["close_passes"].max() > 0
        assert first.run == study.runs.loc[study.runs["close_passes"].idxmax(), "run"]
        closest = next(run for run in others if run.metric == "minimum_clearance")
        assert closest.value == study.runs["minimum_clearance"].min()
        assert closest.run == study.runs.loc[study.runs["minimum_clearance"].idxmin(), "run"]

    def test_never_more_than_asked_for(self, study):
        reasons = pd.Series([run.reason for run in worst_runs(study, 2)])
        assert reasons.value_counts().max() <= 2
        assert worst_runs(study, 0) == []

    def test_best_and_worst_are_the_extremes_of_the_first_context(self, study):
        runs = study.runs[study.runs["crowd.pedestrians"] == 30].set_index("seed")
        sides = {name: frame["completion_time"] for name, frame in runs.groupby("controller")}
        difference = (sides["mpc-paper"] - sides["pid-paper"]).dropna()
        chosen = {pair.reason: pair for pair in example_pairs(study)}
        assert chosen["best"].difference == pytest.approx(difference.min())
        assert chosen["worst"].difference == pytest.approx(difference.max())
        for pair in chosen.values():
            assert (pair.run, pair.run_baseline) == (
                f"c{1 if '30' in pair.context else 3}-s{pair.seed}",
                f"c{2 if '30' in pair.context else 4}-s{pair.seed}",
            )

    @pytest.mark.parametrize(("stops", "reason"), [(1, "median with a stop"), (0, "median")])
    def test_the_typical_pair_is_one_with_a_stop_if_there_is_any(self, changed, stops, reason):
        def same(record):
            return replace(record, rows=tuple({**r, "stops": stops} for r in record.rows))

        pairs = example_pairs(changed(same))
        assert [pair.reason for pair in pairs[:3]] == [reason, "best", "worst"]

    def test_no_pair_is_shown_twice(self, study):
        runs = [pair.run for pair in example_pairs(study)]
        assert len(set(runs)) == len(runs)

    def test_ties_go_to_the_first_run(self, changed):
        def same(record):
            return replace(record, rows=tuple({**r, "minimum_clearance": 0.5} for r in record.rows))

        closest = [run.run for run in worst_runs(changed(same), 3) if "clearance" in run.reason]
        assert closest == ["c1-s1", "c1-s2", "c1-s3"]
