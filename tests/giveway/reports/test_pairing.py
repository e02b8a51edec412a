"""The report's pairs are those of the statistics, with the names of the runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from giveway.reports.pairing import BASELINE, NUMBERS, paired, situation_of
from giveway.studies.statistics.pairs import paired as pairs_of

if TYPE_CHECKING:
    from giveway.studies.folder.study_folder import StudyFolder


def test_both_look_at_the_same_pairs(study: StudyFolder) -> None:
    ours = paired(study)
    groups = [group for _, group in ours.groupby(["context", "ego", "treatment"], sort=False)]
    theirs = list(pairs_of(study.runs, study.design, study.definition.comparison))
    assert len(groups) == len(theirs) > 1
    for group, pairs in zip(groups, theirs, strict=True):
        assert set(group["treatment"]) == {pairs.treatment}
        assert len(group) == len(pairs) > 1
        for name in NUMBERS:
            treated, based = pairs.of(name)
            np.testing.assert_array_equal(group[name], treated)
            np.testing.assert_array_equal(group[name + BASELINE], based)


def test_both_count_the_same_situations(study: StudyFolder) -> None:
    ours = paired(study)
    comparison = study.comparison[study.comparison["metric"] == "stops"]
    for situation in ("general", "stop-and-wait", "non-stop"):
        counted = comparison[comparison["situation"] == situation]["n"].sum()
        assert len(situation_of(ours, situation)) == counted


def test_a_pair_names_its_two_runs(study: StudyFolder) -> None:
    runs = study.runs.set_index("run")
    for pair in paired(study).itertuples():
        here, there = runs.loc[pair.run], runs.loc[pair.run_baseline]
        assert here["seed"] == there["seed"] == pair.seed
        assert here["completion_time"] == pair.completion_time or np.isnan(pair.completion_time)
