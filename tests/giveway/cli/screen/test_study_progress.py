"""What is shown while a study runs: a bar in a terminal, nothing in a quiet one, else lines."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from giveway.cli.screen import study_progress as module
from giveway.cli.screen.study_progress import study_progress
from giveway.studies.study import StudyProgress


def state(made, record=None):
    return StudyProgress(total=8, kept=2, made=made, failed=1, latest=record)


@pytest.fixture
def shown(monkeypatch, small_study):
    """What is printed of three runs on a console, and how many the watcher has counted."""
    monkeypatch.setattr(module, "_LINE", 0.0)

    def show(**console):
        text = io.StringIO()
        with study_progress(Console(file=text, width=100, **console), "small") as watcher:
            for made, record in enumerate(small_study.records[:3], start=1):
                watcher(state(made, record))
        assert watcher.made == 3
        return text.getvalue()

    return show


def test_a_terminal_shows_a_bar_with_failures(shown):
    text = shown(force_terminal=True)
    assert "study small" in text
    assert "1 failed" in text


def test_a_file_gets_lines_with_the_time_left(shown):
    lines = shown().splitlines()
    counts = [line.split("  ")[0] for line in lines]
    assert counts == [f"study small: {done}/8 runs" for done in (3, 4, 5)]
    assert all("1 failed, about 0 min left" in line for line in lines)


def test_a_quiet_console_shows_nothing(shown):
    assert shown(quiet=True) == ""
