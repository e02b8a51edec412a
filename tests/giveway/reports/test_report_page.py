"""The report: one file, nothing from elsewhere, the study's own numbers, the same bytes again."""

from __future__ import annotations

import math
import re
import threading
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from itertools import pairwise

import pytest

from giveway.errors import GivewayError, ResultsError
from giveway.reports.choice import example_pairs
from giveway.reports.report_page import shown_runs, write_report
from giveway.studies.statistics import METRICS

LIMIT = 5_000_000  # bytes


def test_it_needs_nothing_but_itself(report, parsed):
    page = parsed(report)
    for tag, values in page.tags:
        assert tag not in {"link", "iframe", "object", "embed", "base"}
        for name in ("src", "srcset", "data", "action", "xlink:href"):
            assert name not in values
    html = report.read_text("utf-8")
    assert not re.search(r"@import|url\(\s*[\"']?(?!#)", html)
    assert not re.search(r"(?:https?:)?//[\w.-]+\.\w", html)
    assert len(html.encode()) < LIMIT


class Elsewhere(BaseHTTPRequestHandler):
    """Somebody who would like to be told."""

    def do_GET(self):
        self.server.asked.append(self.path)
        self.send_error(404)

    def log_message(self, *_):
        pass


@pytest.fixture
def elsewhere():
    with ThreadingHTTPServer(("127.0.0.1", 0), Elsewhere) as server:
        server.asked = []
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


def test_in_a_browser_names_are_inert_and_nothing_is_fetched(report, chromium, tmp_path, elsewhere):
    """The study's title holds a script; and what a slip let through could still reach nobody."""
    host = f"http://127.0.0.1:{elsewhere.server_port}"
    slip = f'''<img src="{host}/image"><iframe src="{host}/frame"></iframe>
        <script>fetch("{host}/fetched").catch(() => 0)</script>
        <script src="{host}/script"></script></main>'''
    html = report.read_text("utf-8").replace("</main>", slip)
    policy = re.search(r"<meta http-equiv[^>]*>", html).group()
    asked = {}
    for name, text in (("sealed", html), ("open", html.replace(policy, ""))):
        page = tmp_path / f"{name}.html"
        page.write_text(text, encoding="utf-8")
        tab = chromium.new_page()
        dialogs, errors = [], []
        tab.on("dialog", lambda dialog, seen=dialogs: (seen.append(dialog), dialog.dismiss()))
        tab.on("pageerror", lambda error, seen=errors: seen.append(error))
        tab.goto(page.as_uri(), wait_until="load")
        assert "<script>alert('x')</script>" in tab.title()
        assert (dialogs, errors) == ([], [])
        assert tab.locator("#summary").is_visible()
        assert tab.locator("th button").count() > 0  # its own script has run
        tab.close()
        asked[name] = set(elsewhere.asked)
        elsewhere.asked.clear()
    assert asked["sealed"] == set()
    assert {"/image", "/frame", "/script"} <= asked["open"]  # that was the policy's doing


def test_every_link_leads_somewhere(report, parsed):
    page = parsed(report)
    assert len(set(page.ids)) == len(page.ids)
    for link in page.links:
        if link.startswith("#"):
            assert link[1:] in page.ids
        else:
            assert (report.parent / link).is_file()
    used = [re.findall(r"url\(#([^)]+)\)", value) for _, v in page.tags for value in v.values()]
    used += [[v["href"][1:]] for tag, v in page.tags if tag == "use"]
    assert {name for names in used for name in names} <= set(page.ids)


def test_runs_that_are_shown_link_to_their_replay(study, report, parsed):
    links = {link for link in parsed(report).links if not link.startswith("#")}
    assert links == {f"replays/{run}.html" for run in shown_runs(study)}


def test_the_summary_is_made_of_the_numbers(study, report, parsed):
    text = parsed(report).text
    frame = study.comparison
    verdicts = frame["verdict"].value_counts()
    enough = int(len(frame) - verdicts.get("N.A.", 0))
    assert f"{enough} comparisons have enough pairs" in text
    assert f"{verdicts.get('better', 0)} better, {verdicts.get('worse', 0)} worse" in text
    assert "36 runs on 9 crowds per cell (seeds 1 to 9)" in text


def test_every_metric_is_explained(report, parsed):
    page = parsed(report)
    assert {f"metric-{metric.name}" for metric in METRICS} <= set(page.ids)


def test_it_can_be_read_without_seeing(report, parsed):
    page = parsed(report)
    levels = [int(tag[1]) for tag, _ in page.tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in pairwise(levels))
    assert all(page.captions.get(name) for name in page.tables)
    pictures = [v["aria-label"] for tag, v in page.tags if v.get("role") == "img"]
    assert len(pictures) == len([tag for tag, _ in page.tags if tag == "svg"]) >= 4
    assert all(len(words) > 20 for words in pictures)
    assert all(v.get("aria-hidden") == "true" for tag, v in page.tags if tag == "svg")
    assert dict(page.tags)["html"] == {"lang": "en"}


def test_the_same_study_gives_the_same_bytes(study, again, report):
    first = {path.name: path.read_bytes() for path in (study.path / "figures").iterdir()}
    known = report.read_bytes()

    def replay(run):
        return study.path / "replays" / f"{run}.html"

    assert write_report(study, drives=again, replay=replay).read_bytes() == known
    second = {path.name: path.read_bytes() for path in (study.path / "figures").iterdir()}
    assert second == first
    assert {name.rpartition(".")[2] for name in second} == {"png", "svg"}


def test_hostile_names_are_text(changed, parsed):
    hostile = '</svg><img src=x onerror=alert(1)> $x_$ & "'
    levels = (
        f"{{ '{hostile}' = {{ controller = 'mpc-paper' }}, '$$' = {{ controller = 'pid-paper' }} }}"
    )

    def rename(text):
        text = text.replace('controller = ["mpc-paper", "pid-paper"]', f"'<b>' = {levels}")
        return text.replace('factor = "controller"', "factor = '<b>'").replace(
            '"pid-paper"', "'$$'"
        )

    page = parsed(write_report(changed(lambda record: record, rename)))
    assert "img" not in dict(page.tags)
    assert "b" not in dict(page.tags)
    assert [values for tag, values in page.tags if tag == "script"] == [{}]  # our own
    assert f"The study compares “{hostile}” with the baseline $$ (<b>)" in page.text
    assert "<script>alert('x')</script> & others" in page.text


def test_a_lost_run_is_told_with_its_cause_and_command(lost, parsed):
    page = parsed(write_report(lost))
    _, row = page.tables["failures-table"]
    assert row == [
        "c1-s3",
        "crashed",
        "SIGKILL <b>at</b> 4.2 s",
        f"giveway rerun {lost.path} c1-s3",
    ]
    assert "1 run has no result" in page.text
    head, *cells = page.tables["cells-table"]
    assert [row[head.index("no result")] for row in cells] == ["1", "0", "0", "0"]


@pytest.mark.usefixtures("unpictured")
def test_an_example_that_cannot_be_made_again_is_left_out(study, tmp_path, parsed):
    def rerun(run):
        raise GivewayError(f"run {run}: other numbers")

    page = parsed(write_report(study, drives=rerun, target=tmp_path / "report.html"))
    assert "are not drawn: run c1-s" in page.text
    assert not [name for name in page.ids if name.startswith("figure-example")]


def test_a_study_without_runs_has_a_report(study, tmp_path, parsed):
    class Empty:
        path, definition, design = tmp_path, study.definition, study.design
        manifest, measured, metrics = study.manifest, study.measured, study.metrics
        runs, comparison = study.runs.iloc[:0], study.comparison.iloc[:0]
        situations, failures = study.situations.iloc[:0], study.failures.iloc[:0]
        execution = study.execution.iloc[:0]

    page = parsed(write_report(Empty()))
    assert "there is no run yet" in page.text
    assert "There is no pair of finished runs to compare." in page.text


def test_a_study_without_goals_reached_is_compared_by_its_waits(changed, parsed):
    def stuck(record):
        rows = ({**row, "completed": False, "completion_time": math.nan} for row in record.rows)
        return replace(record, rows=tuple(rows))

    study = changed(stuck)
    assert {pair.metric for pair in example_pairs(study)} <= {"total_wait", "longest_wait"}
    text = parsed(write_report(study)).text
    assert "nothing can be said on the completion time" in text


def test_a_study_of_which_everything_failed_shows_no_empty_table(changed, parsed):
    study = changed(lambda record: replace(record, ending="failed", rows=(), failure="no net"))
    page = parsed(write_report(study))
    assert "glance-table" not in page.tables
    assert "36 runs have no result" in page.text
    assert all(len(rows) > 1 for rows in page.tables.values())


def test_a_disk_that_refuses_is_one_line(study, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ResultsError, match=r"^[^\n]*cannot be written[^\n]*$"):
        write_report(study, target=tmp_path / "file" / "report.html")
