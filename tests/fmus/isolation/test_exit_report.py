"""How the end of an FMU's process is put into words."""

from __future__ import annotations

import pytest

from fmus.isolation.exit_report import ExitReport, PrintedTail, decode_report


def report(code, *, killed=False, oom=False, printed=""):
    return ExitReport(code, killed=killed, oom=oom, printed=printed)


@pytest.mark.parametrize(
    ("end", "words"),
    [
        (report(0), "ended itself: exit(0) was called"),
        (report(-15), "died of SIGTERM"),
        (report(-50), "died of signal 50"),
        (report(-9), "died of SIGKILL"),
        (report(-9, oom=True), "was killed by the system for lack of memory (SIGKILL)"),
        (report(None), "killed the process that watches over it"),
    ],
)
def test_the_cause_in_words(end, words):
    assert end.cause == words


def test_a_report_crosses_to_another_process():
    end = report(-11, oom=True, printed="Öl")
    assert decode_report(end.encoded()) == end
    assert end.after_printing == ", after printing 'Öl'"


def test_the_last_non_blank_line_is_kept_printable_and_short():
    tail = PrintedTail()
    for piece in (b"first\nse", b"cond \x1b[31mred\xff\r\n", b"\n  \n"):
        tail.add(piece)
    assert tail.last_line().startswith("second ?[31mred")
    tail.add(b"x" * 1_000_000)
    assert tail.last_line().isprintable()
    assert len(tail.last_line()) == 200


def test_without_a_word_there_is_none():
    assert PrintedTail().last_line() == ""
    assert report(-11).after_printing == ""
