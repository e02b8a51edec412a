"""The page of a risk: the answer in words, its doubts, and only what is known."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from support.risks import known_risk

from giveway.reports.risk_page import answer, event_in_words, write_risk_page


@pytest.fixture
def page_of(tmp_path):
    """Writes the page of a risk by a formula: (replays, **changes) -> text."""

    def write(replays=None, **changes):
        (tmp_path / "manifest.json").write_text('{"made": "by a test"}')
        return write_risk_page(known_risk(tmp_path, **changes), replays).read_text("utf-8")

    return write


@pytest.mark.parametrize(
    ("event", "told"),
    [("mais3", "an injury of MAIS3+"), ("impact>20", "a frontal impact above 20 km/h")],
)
def test_the_event_is_told_in_words(event, told):
    assert event_in_words(event) == told


def test_the_answer_stands_on_top_with_its_interval_in_a_run_and_per_km(tmp_path):
    risk = known_risk(tmp_path, runs=400)
    one = risk.estimate
    numbers = f"{one.probability:.2g} in a run (95 %: {one.low:.2g} to {one.high:.2g})"
    assert numbers in answer(risk)
    assert f"or {one.probability / 0.05:.2g} per km" in answer(risk)
    risk.estimate = replace(one, doubts=("it is only a test",))
    assert answer(risk).endswith("The interval may not hold, see below.")
    risk.estimate = replace(one, events=0, probability=0.0)
    assert "was not met: its probability in a run is below" in answer(risk)


def test_the_page_has_all_sections_and_links_only_existing_replays(page_of):
    page = page_of({"r7": "replays/r7.html"})
    titles = re.findall(r"<h2[^>]*>([^<]+)", page)
    assert titles == ["Estimate", "Weights", "Severity", "Why", "Runs with the event", "Settings"]
    assert page.count("<svg") == 2
    assert "http" not in re.sub(r"http-equiv|http://www.w3.org/\S*", "", page)
    assert set(re.findall(r'href="(replays/[^"]+)"', page)) <= {"replays/r7.html"}
    assert "giveway replay" in page


def test_levels_are_shown_where_there_are_some_and_doubts_as_cautions(page_of):
    page = page_of(method="subset", runs=3000)
    assert "Levels and stages" in page
    assert "Levels and stages" not in page_of(runs=400)


def test_too_few_events_have_no_picture_and_say_so(page_of):
    page = page_of(runs=20)
    assert page.count("<svg") == 1
    assert "different vectors have it, and 50 are needed" in page
