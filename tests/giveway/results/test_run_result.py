"""What a result shows of itself, at a prompt and in a notebook."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

import pytest

import giveway
from giveway.errors import ResultsError

if TYPE_CHECKING:
    from pathlib import Path

    from giveway import RunResult


@pytest.fixture(scope="module")
def result() -> RunResult:
    return giveway.run({"crowd.pedestrians": 5, "seed": 2, "time_limit": 4.0})


def test_a_result_is_one_line(result: RunResult) -> None:
    assert repr(result) == (
        "<RunResult shared_space: mpc, 5 pedestrians, seed 2; time limit after 4.00 s>"
    )


def test_a_notebook_shows_a_table(result: RunResult) -> None:
    shown = result._repr_html_()
    clearance = result.summary["minimum_clearance"]
    assert f">{clearance:.2f}</td><td>m</td>" in shown
    assert "nan" not in shown


@pytest.mark.parametrize("kind", ["top_view", "state"])
def test_a_notebook_shows_each_picture(result: RunResult, kind: str) -> None:
    figure = result.plot(kind)  # type: ignore[arg-type]
    assert figure._repr_png_().startswith(b"\x89PNG")  # type: ignore[attr-defined]


def test_a_run_without_ego_has_its_view_from_above() -> None:
    alone = giveway.run({"crowd.pedestrians": 3, "ego.none": True, "time_limit": 2.0})
    assert alone.plot().axes
    assert "shared_space: no ego, 3 pedestrians" in repr(alone)
    with pytest.raises(ResultsError, match=r"ego = 0: the run has 0"):
        alone.plot("state")


def test_what_cannot_be_drawn_is_said(result: RunResult) -> None:
    with pytest.raises(ResultsError, match="kind = 'side': expected one of 'top_view', 'state'"):
        result.plot("side")  # type: ignore[arg-type]
    with pytest.raises(ResultsError, match="ego = 1: the run has 1, counted from 0"):
        result.plot(ego=1)


def test_a_replay_is_shown_and_saved(result: RunResult, tmp_path: Path) -> None:
    replay = result.replay()
    page = replay.save(tmp_path / "replay.html").read_text(encoding="utf-8")
    assert html.escape(page) in replay._repr_html_()
    assert "seed 2" in page
    assert len(repr(replay)) < 80
    with pytest.raises(ResultsError, match="cannot be written"):
        replay.save(tmp_path / "no" / "folder.html")
