"""Tables of a report: they hold what the study's tables hold."""

from __future__ import annotations

from giveway.reports.wording import digits_for, number


def test_the_comparison_table_holds_the_frame(study, report, parsed):
    head, *rows = parsed(report).tables["comparison-table"]
    frame = study.comparison
    assert len(rows) == len(frame)
    place = {name: head.index(name) for name in ("mean difference", "pairs", "verdict")}
    for row, known in zip(rows, frame.to_dict("records"), strict=True):
        assert row[place["verdict"]] == known["verdict"]
        assert int(row[place["pairs"]]) == known["n"]
        digits = digits_for(known["ci_high"] - known["ci_low"])
        assert row[place["mean difference"]] == number(known["mean_difference"], digits)
        assert row[:2] == [str(known["crowd.pedestrians"]), known["situation"]]


def test_the_cells_table_has_means_of_the_runs(study, report, parsed):
    head, *rows = parsed(report).tables["cells-table"]
    for row in rows:
        runs = study.runs[study.runs["cell"] == int(row[0])]
        assert int(row[head.index("runs")]) == len(runs)
        mean = runs["completion_time"].mean()
        assert row[head.index("completion time [s]")] == number(mean)
