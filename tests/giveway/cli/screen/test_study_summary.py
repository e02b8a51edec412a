"""What ``giveway study`` prints at the end: legible in a narrow terminal, and true."""

from __future__ import annotations

import io
import json

import pandas as pd
import pytest
from rich.console import Console

from giveway.cli.screen.study_summary import Effort, print_summary
from giveway.reports.findings_in_words import findings
from giveway.reports.tables.level_table import level_table, levels_section


@pytest.fixture
def printed():
    """What is printed of a study: (study, width, made) -> text."""

    def print_(study, *, width=80, made=20):
        text = io.StringIO()
        console = Console(file=text, width=width)
        print_summary(console, study, Effort(made, 3.0, 2))
        return text.getvalue()

    return print_


@pytest.mark.parametrize("width", [60, 80, 200])
def test_every_number_is_whole_at_any_width(small_study, printed, width):
    text = printed(small_study, width=width)
    frame = small_study.comparison
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
    study_of, small_study_text, printed, tmp_path
):
    study = study_of(small_study_text + "confidence = 0.8\n", tmp_path / "study")
    text = printed(study)
    assert "80 % interval" in text
    assert "95 %" not in text


def test_the_primary_outcome_stands_first(study_of, small_study_text, printed, tmp_path):
    wanted = '[primary_outcome]\nmetric = "rms_jerk"\nsmallest_effect = 0.1\nreason = "felt"\n'
    text = printed(study_of(f"{small_study_text}\n{wanted}", tmp_path / "study"))
    assert text.count("RMS jerk [m/s^3], general") == 1
    assert text.index("RMS jerk [m/s^3], general") < text.index("minimum clearance")


def test_what_has_no_pair_is_one_line(small_study, printed):
    text = " ".join(printed(small_study).split())
    assert "In no pair on both sides: completion time (general)" in text


def test_few_pairs_have_a_mean_and_the_seeds_intervals_need(
    study_of, small_study_text, printed, tmp_path
):
    study = study_of(small_study_text.replace("minimum_pairs = 4", "minimum_pairs = 12"), tmp_path)
    text = printed(study, width=200)
    rows = study.comparison[study.comparison["metric"] == "rms_jerk"]
    row = rows[rows["situation"] == "general"].iloc[0]
    assert (row["n"], row["verdict"]) == (5, "N.A.")
    assert f"{row['mean_difference']:+.3f}" in text
    assert (
        "Intervals need 12 pairs: 7 more where there are 5; --resume --runs 12 adds seeds" in text
    )


def test_a_resumed_study_says_how_many_runs_are_new(small_study, printed):
    assert "20 runs in 3 s on 2 workers" in printed(small_study, width=200)
    assert "20 runs, 3 of them made now, in 3 s on 2 workers" in printed(
        small_study, width=200, made=3
    )


def test_seeds_that_are_not_precise_enough_are_told(study_of, small_study_text, printed, tmp_path):
    rule = '[precision]\nmetric = "minimum_clearance"\nwidth = {}\nminimum = 10\n'
    text = small_study_text.replace("replications = 5", "replications = 11")
    vague = study_of(text + rule.format(1e-9), tmp_path / "vague")
    assert "Not precise enough, minimum clearance (general) to 1e-09 m, with all 11" in printed(
        vague, width=200
    )
    narrow = study_of(text + rule.format(9.0), tmp_path / "narrow")
    assert "Precise enough, minimum clearance (general) to 9 m, with 10 seeds" in printed(
        narrow, width=200
    )


def test_without_an_ego_there_is_nothing_to_compare(study_of, small_study_text, printed, tmp_path):
    text = small_study_text.replace("time_limit = 2.0", "time_limit = 2.0\nego.none = true")
    study = study_of(text.replace("replications = 5", "replications = 4"), tmp_path / "study")
    assert "The runs have no ego" in printed(study)
    assert "every metric is an ego's" in findings(study)[0]


@pytest.fixture(scope="module")
def of_levels(study_of, small_study_text, tmp_path_factory):
    """The small study, which shows its levels."""
    text = small_study_text.replace("replications = 5", 'replications = 5\ntable = "levels"')
    text = text.replace('["mpc", "pid"]', '["mpc-paper", "pid-paper"]')
    near = "time_limit = 2.0\ncrowd.spawn_area = [8.0, -4.0, 14.0, 0.0]"  # so that much varies
    text = text.replace("time_limit = 2.0", near)
    return study_of(text, tmp_path_factory.mktemp("levels") / "study")


def headings_of(text):
    """The rules below the headings: one for each group of columns."""
    return [line for line in text.splitlines() if set(line) == {"─"}]


@pytest.mark.parametrize("width", [60, 80, 300])
def test_every_level_stands_in_every_column_at_any_width(of_levels, printed, width):
    """A block per crowd, a row per controller; what does not fit stands below."""
    text = printed(of_levels, width=width)
    assert max(map(len, text.splitlines())) <= width
    assert "…" not in text
    assert (len(headings_of(text)) == 1) == (width == 300)
    assert text.count("  mpc-paper") == text.count("  pid-paper") == 2 * len(headings_of(text))
    for heading in ("RMS jerk", "frontal", "min. gap", "conflicts", "control step"):
        assert text.count(heading) == 1
    assert text.count("completion") == 2  # of all, and of the slowed ones
    frame = of_levels.levels
    for row in frame[frame["metric"] == "rms_jerk"].to_dict("records"):
        assert f"{row['mean']:.0f}" in text


def test_a_level_s_mean_has_half_the_width_of_its_interval(of_levels):
    table = level_table(of_levels)
    assert [row.level for row in table.rows] == ["mpc-paper", "pid-paper"] * 2
    assert [row.context for row in table.rows] == ["pedestrians = 3"] * 2 + ["pedestrians = 2"] * 2
    column = [heading for heading, _ in table.headings].index("RMS jerk")
    frame = of_levels.levels
    frame = frame[frame["metric"] == "rms_jerk"]
    for row, known in zip(table.rows, frame.to_dict("records"), strict=True):
        mean, half = map(float, row.means[column].text.split(" ±"))
        wanted = (known["ci_high"] - known["ci_low"]) / 2.0
        assert mean == pytest.approx(known["mean"], abs=0.1 * wanted + 0.5)
        assert half == pytest.approx(wanted, rel=0.3)


def test_what_control_steps_took_is_told_by_cell(of_levels):
    execution, computing = of_levels.execution, of_levels.computing
    assert (execution["control_median"] > 0.0).all()
    assert (execution["control_max"] >= execution["control_median"]).all()
    for cell in computing.to_dict("records"):
        own = execution[execution["run"].str.startswith(f"c{cell['cell']}-")]
        assert cell["runs"] == len(own) == 5
        assert cell["control_median"] == own["control_median"].median()
        assert cell["control_max"] == own["control_max"].max()


def test_levels_and_computing_are_described_by_the_data_package(of_levels):
    package = json.loads((of_levels.path / "datapackage.json").read_text("utf-8"))
    by_name = {entry["name"]: entry for entry in package["resources"]}
    for name in ("levels", "computing"):
        frame = pd.read_csv(of_levels.path / f"{name}.csv")
        described = [field["name"] for field in by_name[name]["schema"]["fields"]]
        assert list(frame.columns) == described
        assert all(field["description"] for field in by_name[name]["schema"]["fields"])
    units = {field["name"]: field.get("unit") for field in by_name["computing"]["schema"]["fields"]}
    assert (units["control_max"], units["seconds"]) == ("ms", "s")


def test_the_report_has_the_table_only_if_it_is_asked_for(small_study, of_levels):
    assert levels_section(small_study) is None
    table = levels_section(of_levels)
    assert len(table.rows) == 4
    assert all(len(row) == len(table.headings) for row in table.rows)
