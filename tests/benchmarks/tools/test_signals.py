"""A sample of the campaign of signals, and its verdicts."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import Any

import pytest
import signals
from campaign_nursery import Nursery
from signals_commands import COMMANDS, Command
from signals_verdicts import Ended, judge

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

TERM = int(signal.SIGTERM)
LINE = "error: ended by SIGTERM\n"
END: dict[str, Any] = {
    "code": 143,
    "hung": False,
    "sent": 0.5,
    "first": 0.1,
    "seconds": 0.7,
    "out": "",
    "err": LINE,
    "left": (),
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> signals.Campaign:
    out = tmp_path_factory.mktemp("signals")
    campaign = signals.Campaign(out, Nursery(out / "cache"))
    # the sample's instants; a measured duration would double its time
    campaign.times |= {"run": (0.05, 2.0), "run-alone": (0.05, 1.6), "check": (0.05, 1.2)}
    return campaign


@pytest.mark.parametrize(
    ("command", "number"),
    [("run", 5), ("run", 3), ("run-alone", 0), ("run-alone", 6), ("check", 7), ("check", 9)],
)
def test_a_command_that_a_signal_ends_says_one_line(
    campaign: signals.Campaign, command: str, number: int
) -> None:
    verdict = campaign.try_case(100, command, number)
    assert not verdict.bad, verdict


def test_commands_hear_what_a_job_in_the_background_ignores() -> None:
    before = {number: signal.signal(number, signal.SIG_IGN) for number in signals.SIGNALS}
    try:
        signals.hear_signals()
        assert all(signal.getsignal(number) != signal.SIG_IGN for number in signals.SIGNALS)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def test_a_case_is_determined_by_seed_command_and_number() -> None:
    assert signals.draw(1, "run", 3) == signals.draw(1, "run", 3)
    shots = [signals.draw(1, "run", number) for number in range(200)]
    instants = [shot.instant(0.1, 5.0) for shot in shots]
    assert min(instants) >= 0.1
    assert max(instants) <= 5.0
    assert sum(instant < 0.6 for instant in instants) > 50  # the imports
    assert sum(instant > 4.75 for instant in instants) > 30  # the last instants
    assert {shot.number for shot in shots} == set(signals.SIGNALS)


@pytest.mark.parametrize(
    ("end", "outcome"),
    [
        ({}, "line"),
        ({"err": f"note: SIGTERM has not been heard yet\n{LINE}"}, "line"),
        ({"code": -15, "err": "", "out": "Results in out"}, "died"),
        ({"code": -15, "err": ""}, "mute"),
        ({"code": 0, "err": ""}, "finished"),
        ({"sent": 0.0}, "late"),
        ({"sent": 0.05}, "early"),
        ({"hung": True}, "hang"),
        ({"err": "Traceback (most recent call last):\n"}, "traceback"),
        ({"err": "error: ImportError: numpy\n"}, "traceback"),
        ({"left": ("giveway run",)}, "process"),
        ({"code": 130}, "code"),
        ({"err": ""}, "mute"),
        ({"err": LINE + LINE}, "noise"),
        ({"code": 0}, "noise"),
        ({"err": "error: ended by SIGTERM; rows up to then are in out\n"}, "lost"),
    ],
)
def test_the_verdict_on_an_end(tmp_path: Path, end: dict[str, Any], outcome: str) -> None:
    (tmp_path / "tmp").mkdir()
    verdict = judge("check", 1, Ended(**END | end), tmp_path, COMMANDS["check"], TERM, "SIGTERM")
    assert verdict.outcome == outcome


@pytest.mark.parametrize(
    ("file", "content", "outcome"),
    [
        ("tmp/giveway-journal-1", "", "scratch"),
        ("page.html", "<html>", "torn"),
        ("page.html", "<html></html>\n", "line"),
        ("ego.csv.new", "", "torn"),
    ],
)
def test_what_is_left_behind_is_not_right(
    tmp_path: Path, file: str, content: str, outcome: str
) -> None:
    (tmp_path / "tmp").mkdir()
    (tmp_path / file).write_text(content)
    command = Command(COMMANDS["check"].prepare, pages=("page.html",))
    assert judge("c", 1, Ended(**END), tmp_path, command, TERM, "").outcome == outcome
