"""Published numbers beside ours."""

from __future__ import annotations

from giveway.reports.report_page import write_report
from giveway.reports.wording import number
from giveway.studies.statistics import PUBLISHED


def test_published_numbers_stand_beside_ours(study, report, parsed):
    head, *rows = parsed(report).tables["published-table"]
    assert len(rows) == len(PUBLISHED)
    for row, ((pedestrians, situation), mean) in zip(rows, PUBLISHED.items(), strict=True):
        assert row[:2] == [str(pedestrians), situation]
        assert row[head.index("Yang & Özgüner 2019")] == number(mean, 4)


def test_without_a_reference_nothing_is_published(changed, parsed):
    study = changed(lambda record: record, lambda text: text.replace('"yang2019"', '""'))
    page = parsed(write_report(study))
    assert "published-table" not in page.tables
    assert "Özgüner" not in page.text
