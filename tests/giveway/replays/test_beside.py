"""Two replays on one page: each whole, both in step, whichever is moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from giveway import run
from giveway.replays import content_of, write_beside

if TYPE_CHECKING:
    from pathlib import Path

SETTLED = "new Promise(r => setTimeout(() => r(), 250))"
TIMES = "[...document.querySelectorAll('iframe')].map(f => f.contentWindow.replay.time)"


@pytest.fixture(scope="module")
def both(recorded: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("beside")
    crowd = {"pedestrians": 3}
    run({"seed": 4, "time_limit": 3.0, "crowd": crowd}, results=folder / "short", pictures=False)
    return write_beside([content_of(recorded), content_of(folder / "short")], folder / "both.html")


def test_both_are_on_the_page_and_whole(watch, both):
    watched = watch(both)
    tab = watched.tab
    tab.evaluate(SETTLED)
    assert tab.evaluate("document.querySelectorAll('iframe').length") == 2
    titles = tab.evaluate("[...document.querySelectorAll('iframe')].map(f => f.title)")
    assert "MPC" in titles[0]
    assert "seed 4" in titles[1]
    drawn = "[...document.querySelectorAll('iframe')].map(f => f.contentWindow.replay.scale > 0)"
    assert tab.evaluate(drawn) == [True, True]
    assert watched.complaints == []
    assert watched.requests == []


def test_whichever_is_moved_the_other_goes_along(watch, both):
    watched = watch(both)
    tab = watched.tab
    tab.evaluate(SETTLED)
    left, right = tab.evaluate(TIMES)
    move = "([i, t]) => document.querySelectorAll('iframe')[i].contentWindow.replay.seek(t)"
    tab.evaluate(move, [0, left + 1.5])
    tab.evaluate(SETTLED)
    assert tab.evaluate(TIMES) == pytest.approx([left + 1.5, right + 1.5], abs=1e-6)
    tab.evaluate(move, [1, right + 0.5])
    tab.evaluate(SETTLED)
    assert tab.evaluate(TIMES) == pytest.approx([left + 0.5, right + 0.5], abs=1e-6)
    tab.evaluate(move, [0, left + 6.0])  # the shorter one stands at its end
    tab.evaluate(SETTLED)
    assert tab.evaluate(TIMES) == pytest.approx([left + 6.0, right + 3.0], abs=0.051)
    assert watched.complaints == []


def test_playing_one_plays_both(watch, both):
    watched = watch(both)
    tab = watched.tab
    tab.evaluate(SETTLED)
    left, right = tab.evaluate(TIMES)
    tab.evaluate(
        "document.querySelectorAll('iframe')[1].contentDocument.getElementById('play').click()"
    )
    tab.evaluate("new Promise(r => setTimeout(() => r(), 1200))")
    now = tab.evaluate(TIMES)
    assert now[1] > right + 0.3
    assert now[0] - left == pytest.approx(now[1] - right, abs=0.2)


def test_a_phone_has_them_one_below_the_other(watch, both):
    watched = watch(both, viewport={"width": 400, "height": 800})
    tab = watched.tab
    tops = "[...document.querySelectorAll('iframe')].map(f => f.getBoundingClientRect().top)"
    first, second = tab.evaluate(tops)
    assert second > first + 300
