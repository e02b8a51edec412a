"""A metric of another package measures a drive: as docs/plugins.md prints it, in real runs."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest
from support.plug_ins import installed, printed  # noqa: F401 - a fixture

import giveway
from giveway.errors import ConfigError, ControlError, MetricError
from giveway.studies.folder.study_folder import StudyFolder

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RUN: dict[str, Any] = {"scenario": "street", "time_limit": 8.0}
NAMES = ["fast_near_time", "fast_near_people"]
NAMED: dict[str, Any] = {"fast-and-near": {"speed": 2.0, "distance": 30.0}}
OWN = """
from dataclasses import dataclass
from typing import Annotated
import numpy as np
from giveway.run_data.columns import Quantity

{dataclass}
class Columns:
    {column}: Annotated[{type}, Quantity("m", "some number")]

class Own:
    Columns = Columns

    def measure(self, drive):
        {body}
"""


@pytest.fixture
def near(installed: Callable[..., Path]) -> None:  # noqa: F811
    points = tomllib.loads(printed("file: metric pyproject.toml"))["project"]["entry-points"]
    ((name, value),) = points["giveway.metrics"].items()
    text = printed("file: fast_and_near.py")
    installed("fast_and_near", text, declares=f"{name} = {value}", group="giveway.metrics")


def own(
    column: str = "own", kind: str = "int", body: str = "return Columns(3)", **more: str
) -> str:
    values = {"dataclass": "@dataclass(frozen=True)"} | more
    return OWN.format(column=column, type=kind, body=body, **values)


def test_the_printed_metric_adds_its_columns(near: None, tmp_path: Path) -> None:
    plain = giveway.run(RUN)
    result = giveway.run(RUN | {"metrics": NAMED}, results=tmp_path / "run", pictures=False)
    table = pd.read_csv(tmp_path / "run" / "summary.csv")
    assert list(table.columns)[-2:] == NAMES
    (ego,) = result.egos
    centres = np.hypot(
        ego.track.front_x[ego.crowd.step] - ego.crowd.x,
        ego.track.front_y[ego.crowd.step] - ego.crowd.y,
    )
    within = (centres < 25.0) & (ego.track.speed[ego.crowd.step] > 2.0)
    assert 0 < len(set(ego.crowd.pedestrian[within])) <= table.loc[0, "fast_near_people"]
    assert 0.0 < table.loc[0, "fast_near_time"] <= 8.0
    told = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert told["fast_near_people"] == table.loc[0, "fast_near_people"]
    rest = {name: value for name, value in result.summary.items() if name not in NAMES}
    np.testing.assert_equal(rest, plain.summary)
    assert not set(NAMES) & set(plain.summary)


def test_data_package_manifest_and_config_name_it(near: None, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    giveway.run(RUN | {"metrics": NAMED, "time_limit": 1.0}, results=folder, pictures=False)
    package = json.loads((folder / "datapackage.json").read_text())
    (summary,) = [table for table in package["resources"] if table["name"] == "summary"]
    time, people = summary["schema"]["fields"][-2:]
    assert (time["name"], time["type"], time["unit"]) == (NAMES[0], "number", "s")
    assert (people["type"], people["description"][:6]) == ("integer", "people")
    (told,) = json.loads((folder / "manifest.json").read_text())["metrics"].values()
    assert (told["name"], told["distribution"]) == ("fast-and-near", "fast-and-near")
    assert told["options"] == NAMED["fast-and-near"]
    assert tomllib.loads((folder / "config.toml").read_text())["metrics"] == NAMED
    again = giveway.run(str(folder / "config.toml"))
    assert set(NAMES) <= set(again.summary)


def test_the_printed_table_and_options_are_read(near: None) -> None:
    metrics = tomllib.loads(printed("metric run"))["metrics"]
    slow = giveway.run(RUN | {"metrics": metrics, "regulation": {"reference_speed": 3.0}})
    assert slow.summary["fast_near_time"] == 0.0


def test_every_ego_of_a_run_is_measured(near: None) -> None:
    egos = [{"ego": {"id": "front", "depart_position": 40.0}}, {"ego": {"id": "rear"}}]
    result = giveway.run(RUN | {"metrics": NAMED, "egos": egos})
    assert result.summary_table[NAMES].notna().all(axis=None)
    assert len(result.summary_table) == 2


@pytest.mark.parametrize(
    ("kind", "body", "said"),
    [
        ("int", "raise ValueError('no')", "raised ValueError: no (own.py:"),
        ("int", "raise SystemExit(3)", "raised SystemExit: 3"),
        ("int", "return 3.0", "returned 3.0: expected an instance of its Columns"),
        ("int", "return Columns(float('nan'))", "returned own = nan: expected a whole number"),
        ("int", "return Columns(True)", "returned own = True: expected a whole number"),
        ("bool", "return Columns(1)", "returned own = 1: expected True or False"),
        ("float", "return Columns('3')", "returned own = '3': expected a finite number"),
        ("float", "return Columns(float('inf'))", "returned own = inf: expected a finite"),
    ],
)
def test_a_fault_costs_its_own_columns_and_is_told(
    near: None,
    installed: Callable[..., Path],  # noqa: F811
    tmp_path: Path,
    kind: str,
    body: str,
    said: str,
) -> None:
    installed("own", own(kind=kind, body=body))
    metrics = {"own:Own": True, **NAMED}
    settings = RUN | {"metrics": metrics, "time_limit": 1.0}
    result = giveway.run(settings, results=tmp_path / "run", pictures=False)
    (told,) = [text for text in result.remarks if "metric" in text]
    assert told.startswith(f"metric 'own:Own' of 'ego' {said}")
    assert told.endswith("; its columns are empty")
    assert told in json.loads((tmp_path / "run" / "manifest.json").read_text())["remarks"]
    table = pd.read_csv(tmp_path / "run" / "summary.csv")
    assert table[["own", *NAMES]].isna().to_numpy().tolist() == [[True, False, False]]


@pytest.mark.parametrize(
    ("kind", "body", "value"),
    [
        ("int", "return Columns(np.int64(3))", 3),
        ("bool", "return Columns(np.bool_(True))", True),
        ("float", "return Columns(np.float32(0.5))", 0.5),
        ("float", "return Columns(int(drive.summary['completed']))", 0.0),
    ],
)
def test_numbers_of_numpy_become_python_s(
    installed: Callable[..., Path],  # noqa: F811
    kind: str,
    body: str,
    value: float,
) -> None:
    installed("own", own(kind=kind, body=body))
    result = giveway.run(RUN | {"metrics": {"own:Own": True}, "time_limit": 0.5})
    assert result.summary["own"] == value
    assert type(result.summary["own"]) is type(value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (own(column="stops"), "column 'stops': giveway has a column of this name already"),
        (own(column="seed"), "column 'seed': giveway has"),
        (own(column="fast_near_time"), "'fast_near_time': 'fast-and-near' has a column"),
        (own(kind="str"), "expected Columns, a dataclass whose attributes are all Annotated"),
        (own(kind="list[int]"), "expected Columns, a dataclass"),
        (own(dataclass=""), "expected Columns, a dataclass"),
        (own().replace('some number"', 'x", better="less"'), "better is neither 'lower' nor"),
        ("class Own:\n    measure = print", "expected Columns, a dataclass"),
        (own().replace("def measure", "def measures"), "has no method measure"),
    ],
)
def test_unusable_columns_are_refused_before_the_run(
    near: None,
    installed: Callable[..., Path],  # noqa: F811
    text: str,
    said: str,
) -> None:
    installed("own", text)
    with pytest.raises(MetricError, match=r"\[metrics\] name = 'own:Own': ") as caught:
        giveway.run(RUN | {"metrics": {**NAMED, "own:Own": True}})
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_study_has_the_columns_in_its_runs(
    near: None,
    installed: Callable[..., Path],  # noqa: F811
    tmp_path: Path,
) -> None:
    installed("own", own(body="return Columns(1 // (drive.config.seed - 2))"))
    metrics = {"fast-and-near": {"distance": 30.0}, "own:Own": True}
    study = {
        "name": "near",
        "replications": 2,
        "run": RUN | {"metrics": metrics},
        "factors": {"metrics.fast-and-near.speed": [2.0, 50.0]},
    }
    giveway.study(study, out=tmp_path / "study", jobs=1)
    runs = pd.read_csv(tmp_path / "study" / "runs.csv", dtype={"own": str})
    assert sorted(runs.columns[-3:]) == sorted([*NAMES, "own"])
    slow = runs["metrics.fast-and-near.speed"] == 2
    assert (runs.loc[slow, "fast_near_time"] > 0.0).all()
    assert (runs.loc[~slow, "fast_near_time"] == 0.0).all()
    assert runs["own"].fillna("").tolist() == ["-1", "", "-1", ""]  # whole, but for the fault
    compared = pd.read_csv(tmp_path / "study" / "comparison.csv")
    assert "own" not in set(compared["metric"])
    assert "fast_near_people" not in set(compared["metric"])
    rows = compared[(compared["metric"] == "fast_near_time") & (compared["n"] == 2)]
    assert "general" in set(rows["situation"])
    assert (rows["mean_difference"] > 0.0).all()
    assert (rows["unit"] == "s").all()
    levels = pd.read_csv(tmp_path / "study" / "levels.csv").query("metric == 'fast_near_time'")
    assert levels["mean"].tolist()[1] == 0.0 < levels["mean"].tolist()[0]
    package = json.loads((tmp_path / "study" / "datapackage.json").read_text())
    (table,) = [table for table in package["resources"] if table["name"] == "runs"]
    described = {field["name"]: field for field in table["schema"]["fields"]}
    assert described["fast_near_time"]["unit"] == "s"
    assert described["own"]["type"] == "integer"
    assert (StudyFolder.open(tmp_path / "study").runs["fast_near_time"][~slow] == 0.0).all()
    command = [sys.executable, "-m", "giveway", "report", str(tmp_path / "study")]
    command += ["--trust", "own:Own"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, check=False)
    assert done.returncode == 0, done.stderr


def test_a_metric_that_ends_the_process_is_named(
    installed: Callable[..., Path],  # noqa: F811
    tmp_path: Path,
) -> None:
    installed("own", own(body="import os; os._exit(7)"))
    words = ["run", "street", "--time-limit", "1", "--metric", "own:Own", "--no-pictures"]
    command = [sys.executable, "-m", "giveway", *words, "--out", str(tmp_path / "run")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode != 0
    assert "in the metric 'own:Own'" in done.stderr
    table = pd.read_csv(tmp_path / "run" / "summary.csv")  # recovered, without its column
    assert "own" not in table.columns
    assert table.loc[0, "simulated_time"] == 1.0


def test_the_screen_shows_what_was_measured(near: None, tmp_path: Path) -> None:
    words = ["run", "street", "--time-limit", "8", "--no-pictures", "--out", str(tmp_path / "run")]
    words += ["--metric", "fast-and-near.speed=2", "--metric", "fast-and-near.distance=30"]
    command = [sys.executable, "-m", "giveway", *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    people = pd.read_csv(tmp_path / "run" / "summary.csv").loc[0, "fast_near_people"]
    rows = [line.replace("│", " ").split() for line in done.stdout.splitlines()]
    assert any(row[-2:] == ["fast_near_people", str(people)] for row in rows)
    (time,) = [row for row in rows if "fast_near_time" in row]
    assert float(time[-2]) > 0.0
    assert time[-1] == "s"


def test_a_twin_s_run_is_measured_with_its_delays(
    installed: Callable[..., Path],  # noqa: F811
) -> None:
    body = "return Columns(float(drive.summary['people_delay']))"
    installed("own", own(kind="float", body=body))
    own_metric = {"metrics": {"own:Own": True}, "twin": True}
    summary = giveway.run(RUN | own_metric | {"time_limit": 3.0}).summary
    assert summary["own"] == summary["people_delay"]


def test_a_factor_may_not_have_a_column_s_name(near: None, tmp_path: Path) -> None:
    masses = (("light", 900.0), ("heavy", 1000.0))
    study = {
        "name": "clash",
        "run": RUN | {"metrics": NAMED},
        "factors": {"fast_near_time": {name: {"vehicle": {"mass": m}} for name, m in masses}},
    }
    with pytest.raises(ConfigError, match="factor 'fast_near_time': a metric of"):
        giveway.study(study, out=tmp_path / "study")


def test_unknown_names_and_options_are_refused_in_words(near: None) -> None:
    with pytest.raises(ConfigError, match="no metric has this name; did you mean 'fast-and-near'"):
        giveway.run(RUN | {"metrics": {"fast-and-nea": True}})
    with pytest.raises(ConfigError, match=r"the run: .*'fast-and-near' has no such option"):
        giveway.run(RUN | {"metrics": {"fast-and-near": {"sped": 3.0}}})
    with pytest.raises(ControlError, match="no installed package has the module 'nowhere'"):
        giveway.run(RUN | {"metrics": {"nowhere:Metric": True}})


def test_a_results_folder_alone_imports_no_metric(near: None, tmp_path: Path) -> None:
    metrics = {"fast_and_near:FastAndNear": True}
    settings = RUN | {"metrics": metrics, "time_limit": 0.5}
    giveway.run(settings, results=tmp_path / "run", pictures=False)
    with pytest.raises(ConfigError, match="--metric fast_and_near:FastAndNear"):
        giveway.run(str(tmp_path / "run" / "config.toml"))


def test_check_says_whether_a_metric_keeps_to_the_rules(
    near: None,
    installed: Callable[..., Path],  # noqa: F811
    type_here: Callable[..., Any],
) -> None:
    words = printed("metric check").split()[1:]
    typed = type_here(*words)
    assert typed.returncode == 0, typed.stdout
    assert "fast-and-near: sound" in typed.stdout
    installed("own", own(body="return Columns(1 // len(drive.crowd.ids))"))
    typed = type_here("check", "metric", "own:Own")
    assert typed.returncode == 1
    assert "broken  answers in corner cases" in typed.stdout
    assert "nobody: metric 'own:Own' of 'ego' raised ZeroDivisionError" in typed.stdout
