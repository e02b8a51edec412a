"""Every results folder plays: crashed, without an ego, with several, with hostile names."""

from __future__ import annotations

import json
import os
import shutil
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest
from support.runs import unseal

from giveway import run
from giveway.errors import ResultsError
from giveway.replays import write_replay

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture
def folder(recorded: Path, tmp_path: Path) -> Path:
    """A copy of the recorded run, to be tampered with."""
    return unseal(shutil.copytree(recorded, tmp_path / "run"))


def content(page: Path) -> dict[str, Any]:
    """The data that a page holds."""
    text = page.read_text(encoding="utf-8")
    data = text.split('<script type="application/json" id="run">')[1].split("</script>")[0]
    return json.loads(data)


def test_hostile_names_stay_text(folder: Path, watch: Callable[..., Any], tmp_path: Path) -> None:
    name = "</script><img src=x onerror=alert(1)>\"'"
    for file in ("trajectories", "pedestrians", "predictions"):
        table = pd.read_csv(folder / f"{file}.csv", dtype={"id": str})
        table["id"] = table["id"].replace("ped0", name)
        table.to_csv(folder / f"{file}.csv", index=False)
    summary = json.loads((folder / "summary.json").read_text())
    summary["scenario"] = "</title><script>alert(2)</script>"
    (folder / "summary.json").write_text(json.dumps(summary))
    watched = watch(write_replay(folder, tmp_path / "hostile.html"))
    assert watched.tab.evaluate("PEOPLE.names").count(name) == 1
    assert summary["scenario"] in watched.tab.inner_text("h1")
    assert watched.tab.locator("img").count() == 0
    assert (watched.complaints, watched.requests) == ([], [])


@pytest.mark.parametrize(
    "settings",
    [
        {"ego": {"none": True}, "time_limit": 2.0},
        {"controller": "pid", "time_limit": 2.0},
        {"scenario": "street", "time_limit": 3.0},
        {
            "time_limit": 3.0,
            "crowd": {"pedestrians": 0},
            "egos": [{"ego": {"id": "a"}}, {"ego": {"id": "b", "depart_time": 1.0}}],
        },
    ],
    ids=["no ego", "pid", "traffic", "two egos"],
)
def test_every_kind_of_run_plays(
    settings: dict[str, Any], watch: Callable[..., Any], tmp_path: Path
) -> None:
    result = run(settings, results=tmp_path / "r", pictures=False)
    watched = watch(write_replay(tmp_path / "r", tmp_path / "page.html"))
    for time in np.linspace(result.time[0], result.time[-1], 5):
        watched.seek(float(time))
    assert watched.complaints == []
    assert watched.tab.evaluate("EGOS.length") == len(result.egos)
    assert watched.tab.locator("#ego-box").is_visible() == (len(result.egos) > 1)
    assert watched.tab.evaluate("EGOS.map(ego => [ego.length, ego.width])") == [
        [ego.shape.length, ego.shape.width] for ego in result.egos
    ]


def test_a_crashed_run_plays_and_says_so(
    folder: Path, watch: Callable[..., Any], tmp_path: Path
) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest |= {"ending": "crashed", "error": "SIGSEGV inside SUMO's step", "time_step": None}
    manifest["sumo"] = {}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    for lost in ("scene.json", "pedestrians.csv", "predictions.csv", "summary.json"):
        (folder / lost).unlink()
    watched = watch(write_replay(folder, tmp_path / "page.html"))
    watched.seek(3.0)
    assert watched.complaints == []
    notes = watched.tab.inner_text("#notes")
    assert "SIGSEGV" in notes
    assert "No predictions" in notes
    assert watched.tab.inner_text("#ending") == "crashed"


def test_walkers_who_come_and_go_with_the_zone_are_explained(folder: Path, tmp_path: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    assert not any(
        "--zone" in note for note in content(write_replay(folder, tmp_path / "a"))["notes"]
    )
    manifest["pedestrians"]["handed_back"] = 3
    (folder / "manifest.json").write_text(json.dumps(manifest))
    assert any("--zone" in note for note in content(write_replay(folder, tmp_path / "b"))["notes"])


def test_a_folder_that_is_no_run_is_one_clear_line(
    folder: Path, tmp_path: Path, refused: Any
) -> None:
    with refused(ResultsError, tmp_path / "nowhere", "no such folder", "giveway run"):
        write_replay(tmp_path / "nowhere", tmp_path / "page.html")
    with refused(ResultsError, tmp_path, "config.toml", "giveway run"):
        write_replay(tmp_path, tmp_path / "page.html")
    (folder / "ego.csv").write_text("time,id\n1,2,3,4\n")
    with refused(ResultsError, folder / "ego.csv"):
        write_replay(folder, tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()


@pytest.mark.parametrize(
    ("file", "column", "cell", "shown"),
    [
        ("ego.csv", "x", "x" * 5000, "'" + "x" * 40 + "'"),
        ("ego.csv", "speed", "", "nothing"),
        ("ego.csv", "gap", "1.5x", "'1.5x'"),
        ("trajectories.csv", "y", "inf", "'inf'"),
        ("trajectories.csv", "vx", "<b>", "'<b>'"),
        ("trajectories.csv", "vy", "", "nothing"),
        ("pedestrians.csv", "minimum_clearance", "ped2", "'ped2'"),
    ],
)
def test_what_is_no_number_is_one_clear_line(
    folder: Path, tmp_path: Path, refused: Any, file: str, column: str, cell: str, shown: str
) -> None:
    broken = tmp_path / "broken"
    shutil.copytree(folder, broken)
    head, first, *others = (broken / file).read_text().splitlines()
    names, cells = head.split(","), first.split(",")
    assert len(cells) == len(names)
    cells[names.index(column)] = cell
    (broken / file).write_text("\n".join([head, ",".join(cells), *others]) + "\n")
    with refused(ResultsError, broken / file, f"line 2, column '{column}': {shown}; expected"):
        write_replay(broken, tmp_path / "page.html")


@pytest.mark.parametrize(
    ("file", "content"),
    [("summary.json", '{"egos": 3}'), ("summary.json", '{"egos": [3]}')]
    + [("manifest.json", '{"remarks": 3}')],
)
def test_what_a_replay_can_do_without_may_be_anything(
    folder: Path, tmp_path: Path, file: str, content: str
) -> None:
    strange = tmp_path / "strange"
    shutil.copytree(folder, strange)
    (strange / file).write_text(content)
    write_replay(strange, tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 10_000


@pytest.mark.parametrize(
    "road", ["[" * 3000 + "]" * 3000, f"[[[0.0, {'1' * 400}]]]"], ids=["deep", "400 digits"]
)
def test_a_scene_that_is_a_bomb_is_one_line(
    folder: Path, tmp_path: Path, refused: Any, road: str
) -> None:
    (folder / "scene.json").write_text(f'{{"road": {road}, "bodies": {{}}}}')
    with refused(ResultsError, folder / "scene.json", "is not JSON"):
        write_replay(folder, tmp_path / "page.html")


def test_a_scene_with_infinite_numbers_is_left_out(folder: Path, tmp_path: Path) -> None:
    (folder / "scene.json").write_text('{"road": [[[0.0, 1e999]]], "bodies": {"ego": [1e999, 2]}}')
    assert content(write_replay(folder, tmp_path / "page.html"))["road"]["x"] == ""


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize("name", ["config.toml", "manifest.json", "ego.csv", "scene.json"])
def test_a_pipe_or_a_link_in_place_of_a_file_is_one_line(
    folder: Path, tmp_path: Path, refused: Any, name: str
) -> None:
    file = folder / name
    file.rename(tmp_path / name)
    file.symlink_to(tmp_path / name)
    with refused(ResultsError, file, "is a link"):
        write_replay(folder, tmp_path / "page.html")
    file.unlink()
    os.mkfifo(file)
    with refused(ResultsError, folder, "expected"):  # a table that is none, or a pipe
        write_replay(folder, tmp_path / "page.html")


def test_the_page_is_not_written_through_a_link(folder: Path, tmp_path: Path, refused: Any) -> None:
    (tmp_path / "precious").write_text("mine")
    (folder / "replay.html").symlink_to(tmp_path / "precious")
    with refused(ResultsError, folder / "replay.html", "is a link"):
        write_replay(folder, folder / "replay.html")
    assert (tmp_path / "precious").read_text() == "mine"


def test_a_page_that_cannot_be_written_is_one_clear_line(folder: Path, refused: Any) -> None:
    with refused(ResultsError, folder / "ego.csv" / "page.html", "--out"):
        write_replay(folder, folder / "ego.csv" / "page.html")


def test_the_same_run_makes_the_same_bytes(folder: Path, page: Path, tmp_path: Path) -> None:
    again = write_replay(folder, tmp_path / "again.html")
    assert again.read_bytes() == page.read_bytes()
