"""What ``giveway study`` prints at the end: legible in a narrow terminal, and true."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from giveway.cli.study_summary import print_summary
from giveway.reports.findings import findings


@pytest.fixture
def printed():
    """What is printed of a study: (study, width, made) -> text."""

    def print_(study, *, width=80, made=20):
        text = io.StringIO()
        console = Console(file=text, width=width)
        print_summary(console, study, made=made, elapsed=3.0, workers=2)
        return text.getvalue()

    return print_


@pytest.mark.parametrize("width", [60, 80, 200])
def test_every_number_is_whole_at_any_width(small, printed, width):
    text = printed(small, width=width)
    frame = small.comparison
    rows = frame[(frame["metric"] == "rms_jerk") & (frame["situation"] == "general")]
    assert len(rows) == 2
    for row in rows.to_dict("records"):
        interval = f"{row['ci_low']:+.3f} ... {row['ci_high']:+.3f}"
        assert f"{row['mean_difference']:+.3f}" in text
        assert interval in text
    assert "RMS jerk [m/s^3], general: lower is better" in text
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= width


def test_the_interval_is_headed_by_the_confidence_asked_for(
    study_of, small_text, printed, tmp_path
):
    study = study_of(small_text + "confidence = 0.8\n", tmp_path / "study")
    text = printed(study)
    assert "80 % interval" in text
    assert "95 %" not in text


def test_what_has_too_few_pairs_is_one_line(small, printed):
    text = " ".join(printed(small).split())
    assert "N.A., fewer than 4 pairs with a number on both sides: completion time (general)" in text


def test_a_resumed_study_says_how_many_runs_are_new(small, printed):
    assert "20 runs in 3 s on 2 workers" in printed(small, width=200)
    assert "20 runs, 3 of them made now, in 3 s on 2 workers" in printed(small, width=200, made=3)


def test_seeds_that_are_not_precise_enough_are_told(study_of, small_text, printed, tmp_path):
    rule = '[precision]\nmetric = "minimum_clearance"\nwidth = {}\nminimum = 10\n'
    text = small_text.replace("replications = 5", "replications = 11")
    vague = study_of(text + rule.format(1e-9), tmp_path / "vague")
    assert "Not precise enough, minimum clearance (general) to 1e-09 m, with all 11" in printed(
        vague, width=200
    )
    narrow = study_of(text + rule.format(9.0), tmp_path / "narrow")
    assert "Precise enough, minimum clearance (general) to 9 m, with 10 seeds" in printed(
        narrow, width=200
    )


def test_without_an_ego_there_is_nothing_to_compare(study_of, small_text, printed, tmp_path):
    text = small_text.replace("time_limit = 2.0", "time_limit = 2.0\nego.none = true")
    study = study_of(text.replace("replications = 5", "replications = 4"), tmp_path / "study")
    assert "The runs have no ego" in printed(study)
    assert "every metric is an ego's" in findings(study)[0]
