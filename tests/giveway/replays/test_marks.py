"""Crossings and lights of a junction are on its page, and people are in view when it opens."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

from giveway import run
from giveway.replays import write_replay
from giveway.run_data.road_marks import shown
from giveway.run_data.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture(scope="module")
def junction(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first seconds of a drive towards a light, and their page."""
    folder = tmp_path_factory.mktemp("runs") / "junction"
    run(
        {"scenario": "junction", "seed": 1, "controller": "pid", "time_limit": 14.0},
        results=folder,
        pictures=False,
    )
    write_replay(folder, folder / "replay.html")
    return folder


def test_lights_have_their_recorded_colour_and_crossings_stripes(
    watch: Callable[..., Any], junction: Path
) -> None:
    watched = watch(junction / "replay.html")
    marks = Scene.read(junction).marks
    signals = pd.read_csv(junction / "signals.csv")
    assert len(marks.heads) == 4
    assert len(signals) > 1
    names = {"G": "green", "y": "yellow", "r": "red"}
    for row in (signals.iloc[0], signals.iloc[-1]):
        watched.seek(float(row["time"]))
        for head in marks.heads:
            (x0, y0), (x1, y1) = head.ends
            watched.tab.evaluate(
                "([x, y]) => { [view.x, view.y] = [x - RUN.origin[0], y - RUN.origin[1]];"
                " view.follow = false; player.redraw(); }",
                [(x0 + x1) / 2, (y0 + y1) / 2],
            )
            watched.settle()
            place = watched.place(x1, y1)  # the lamp at the kerb, where no car is
            letter = shown("".join(row["state"][link] for link in head.links))
            assert watched.pixel(*place) == watched.colour(names[letter])
    before = watched.count(watched.colour("unpainted"))
    watched.tab.uncheck("[data-layer=road]")
    watched.settle()
    assert before > 100
    assert watched.count(watched.colour("unpainted")) < before / 10  # shades of other edges


def test_people_are_in_view_when_it_opens(watch: Callable[..., Any], junction: Path) -> None:
    watched = watch(junction / "replay.html")
    rows = pd.read_csv(junction / "trajectories.csv")
    begin = rows[(rows["type"] == "pedestrian") & (rows["time"] == rows["time"].min())]
    box = watched.tab.locator("#stage").bounding_box()
    seen = [watched.place(*place) for place in zip(begin["x"], begin["y"], strict=True)]
    inside = [0 <= x <= box["width"] and 0 <= y <= box["height"] for x, y in seen]
    assert np.sum(inside) >= min(5, len(begin)) > 0
