"""Every results folder plays: crashed, without an ego, with several, with hostile names."""

from __future__ import annotations

import itertools
import json
import shutil
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest

from giveway import run
from giveway.cli.commands.replay_command import replay_command
from giveway.errors import ResultsError
from giveway.replays import write_replay
from giveway.replays.events import events, why
from giveway.replays.packed_tracks import Frame, pack_tracks, thinning

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture
def folder(recorded: Path, tmp_path: Path) -> Path:
    """A copy of the recorded run, to be tampered with."""
    return shutil.copytree(recorded, tmp_path / "run")


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
    [("summary.json", "[1]"), ("summary.json", '{"egos": 3}'), ("summary.json", '{"egos": [3]}')]
    + [("manifest.json", '{"remarks": 3}'), ("manifest.json", "7")],
)
def test_what_a_replay_can_do_without_may_be_anything(
    folder: Path, tmp_path: Path, file: str, content: str
) -> None:
    strange = tmp_path / "strange"
    shutil.copytree(folder, strange)
    (strange / file).write_text(content)
    write_replay(strange, tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 10_000


def test_a_page_that_cannot_be_written_is_one_clear_line(folder: Path, refused: Any) -> None:
    with refused(ResultsError, folder / "ego.csv" / "page.html", "--out"):
        write_replay(folder, folder / "ego.csv" / "page.html")


def test_the_same_run_makes_the_same_bytes(folder: Path, page: Path, tmp_path: Path) -> None:
    again = write_replay(folder, tmp_path / "again.html")
    assert again.read_bytes() == page.read_bytes()


def walk(times: list[float], who: str) -> pd.DataFrame:
    """Somebody who walks along x at 1 m/s."""
    rows = {"time": times, "id": who, "x": times, "y": 0.0, "vx": 1.0, "vy": 0.0, "angle": 90.0}
    return pd.DataFrame(rows)


def numbers(text: str, dtype: str) -> list[float]:
    import base64

    return np.frombuffer(base64.b64decode(text), dtype).tolist()


def test_a_return_makes_two_tracks_and_far_people_stay_on() -> None:
    near = walk([0.0, 0.05, 0.1], "near")
    back = walk([0.0, 1.0, 8.0, 9.0], "back")
    rows = pd.concat([near, back]).sort_values("time", kind="stable", ignore_index=True)
    frame = Frame(0.0, 0.0, np.array([0.0, 0.05, 0.1, 1.0, 8.0, 9.0, 9.5]))
    tracks = pack_tracks(rows, frame, hold=0.05, gap=1.5, thin=0.0)
    assert sorted(tracks["names"]) == ["back", "near"]
    assert len(numbers(tracks["who"], "<u4")) == 3
    until = sorted(numbers(tracks["until"], "<f8"))
    assert until == pytest.approx([0.15, 1.05, 9.55])


def test_thinning_keeps_the_ends_of_tracks_and_far_people_whole() -> None:
    times = [round(0.05 * k, 6) for k in range(201)]
    rows = pd.concat([walk(times, "near"), walk([0.0, 1.0, 2.0, 3.0], "far")], ignore_index=True)
    assert thinning(rows, 0.05, most=1000) == 0.0
    thin = thinning(rows, 0.05, most=60)
    frame = Frame(0.0, 0.0, np.array(times))
    tracks = pack_tracks(rows, frame, hold=0.05, gap=1.5, thin=thin)
    start = [int(s) for s in numbers(tracks["start"], "<u4")]
    x = numbers(tracks["x"], "<i4")
    assert len(x) <= 60
    ends = sorted((x[a], x[b - 1], b - a) for a, b in itertools.pairwise(start))
    assert ends[0] == (0, 3000, 4)
    assert ends[1][:2] == (0, 10000)


@pytest.mark.parametrize(
    ("reason", "text"),
    [
        ("clear", "nobody is in the way"),
        ("drive on", "driving on costs least"),
        ("as planned", "keeps to its plan"),
        ("+0 m/s^2 to 0 m/s", "keeping the speed costs least"),
        ("-2.5 m/s^2 to 1.4 m/s", "slowing down to 1.4 m/s at 2.5 m/s^2 costs least"),
        ("safety layer", "the safety layer brakes"),
    ],
)
def test_what_the_planning_mpc_chose_is_told_in_words(reason: str, text: str) -> None:
    told = why(reason, "solved")
    assert text in told["text"]
    assert not told["infeasible"]


def test_events_are_stops_fallbacks_and_encounters(recorded: Path) -> None:
    from giveway.config import EgoRunConfig

    time = np.arange(6) * 0.5
    rows = pd.DataFrame(
        {
            "time": time,
            "speed": [1.0, 0.1, 0.1, 1.0, 1.0, 0.0],
            "controller": ["mpc", "pid", "pid", "mpc", "mpc", "mpc"],
            "reason": ["optimal", "infeasible", "infeasible", "optimal", "optimal", "optimal"],
            "solver_status": ["solved", *2 * ["infeasible: too close"], *3 * ["solved"]],
        }
    )
    people = pd.DataFrame(
        {
            "id": ["p", "q"],
            "minimum_clearance": [-0.1, 0.4],
            "time_of_minimum_clearance": [1.0, 2.0],
        }
    )
    told = [(e["kind"], e["from"], e["to"]) for e in events(rows, people, EgoRunConfig())]
    assert told == [
        ("pid", 0.5, 1.5),
        ("stop", 0.5, 1.5),
        ("overlap", 1.0, 1.0),
        ("stop", 2.5, 2.5),
    ]


@pytest.mark.parametrize("controller", ["pid-tuned", "mpc-paper"])
def test_the_safety_layers_braking_is_an_event_whoever_drives(controller: str) -> None:
    from giveway.config import EgoRunConfig

    acting = ["pid", "safety", "safety", "pid", "safety", "safety"]
    rows = pd.DataFrame(
        {
            "time": np.arange(6) * 0.5,
            "speed": 1.0,
            "controller": acting,
            "reason": ["", *2 * ["safety layer"], "", *2 * ["unavoidable"]],
            "solver_status": "infeasible: too close",
        }
    )
    found = events(rows, pd.DataFrame(), EgoRunConfig(controller=controller))
    assert [(e["from"], e["to"], e["text"]) for e in found if e["kind"] == "safety"] == [
        (0.5, 1.5, "the safety layer brakes: a stop must stay possible"),
        (2.0, 2.5, "the safety layer brakes: no braking is surely enough"),
    ]


def test_the_command_makes_the_run_again_for_its_predictions(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded = (folder / "predictions.csv").read_bytes()
    (folder / "predictions.csv").unlink()
    assert replay_command(folder) == 0
    assert "replay.html" in capsys.readouterr().out
    made = content(folder / "replay.html")
    (folder / "predictions.csv").write_bytes(recorded)
    assert made["egos"] == content(write_replay(folder, folder / "own.html"))["egos"]


def test_predictions_of_a_run_that_differed_are_not_shown(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "predictions.csv").unlink()
    rows = (folder / "ego.csv").read_text().splitlines(keepends=True)
    rows[5] = rows[6]
    (folder / "ego.csv").write_text("".join(rows))
    assert replay_command(folder) == 0
    assert "went differently" in capsys.readouterr().err
    made = content(folder / "replay.html")
    assert made["egos"][0]["predicted"] is None
    assert any("went differently" in note for note in made["notes"])


def test_no_rerun_makes_no_run(folder: Path) -> None:
    (folder / "predictions.csv").unlink()
    (folder / "config.toml").write_text((folder / "config.toml").read_text() + "# as it was\n")
    assert replay_command(folder, rerun=False) == 0
    made = content(folder / "replay.html")
    assert made["egos"][0]["predicted"] is None
    assert any("--record-predictions" in note for note in made["notes"])
