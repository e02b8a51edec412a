"""At the zebra behind the bundled junction: the ledger of an ego that gives way, or does not."""

import json
from pathlib import Path

import pandas as pd
import pytest
from support.priority import rules_of

from giveway.api import run_checked, simulate
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.metrics.law import LAW_FIELDS
from giveway.metrics.travel import TRAVEL_FIELDS
from giveway.processes.heartbeat import Phase, Pulse
from giveway.processes.supervisor import Verdict
from giveway.recovery import recover
from giveway.results.folder import Destination
from giveway.results.run_result import RunResult

LAW = ("ledger.csv", "people.csv", "signals.csv")


def run(folder: Path, priority: str, *, twin: bool = False) -> RunResult:
    settings = {
        "scenario": "junction",
        "twin": twin,
        "seed": 14,
        "rules": rules_of(priority),
        "ego": {
            "route": ["east_out", "far_east_out"],  # from behind the junction on
            "depart_time": 60.0,
            "depart_position": 10.0,
            "travel_distance": 55.0,
        },
    }
    (folder / "journal").mkdir()
    checked = preflight(*load([as_layer(settings)]))
    return run_checked(
        checked, Destination(folder / "results", pictures=False), journal=folder / "journal"
    )


@pytest.fixture(scope="module", params=["road", "none"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("law")
    return request.param, folder, run(folder, request.param)


def test_the_ledger_tells_who_gave_way_from_who_did_not(made) -> None:
    priority, _, result = made
    kinds = set(result.ledger.loc[result.ledger["violation"], "kind"])
    notes = [text for text in result.remarks if "law of the road" in text]
    assert result.summary["encounters"] >= 1
    if priority == "road":
        assert result.summary["yielding_rate"] == 1.0
        assert (kinds, notes) == (set(), [])
    else:
        assert result.summary["failures_to_yield"] >= 1
        assert "failure to yield" in kinds
        assert len(notes) == 1


def test_every_table_is_there_and_described(made) -> None:
    _, folder, _ = made
    results = folder / "results"
    names = {path.name for path in results.iterdir()}
    assert {"ledger.csv", "people.csv"} <= names
    assert "signals.csv" not in names  # no light on this way
    package = json.loads((results / "datapackage.json").read_text())
    described = {resource["name"] for resource in package["resources"]}
    assert {"ledger", "people"} <= described
    summary = pd.read_csv(results / "summary.csv")
    of_law = [column.name for column in (*LAW_FIELDS, *TRAVEL_FIELDS)]
    assert list(summary.columns)[-len(of_law) :] == of_law
    walkers = set(pd.read_csv(results / "people.csv")["id"])
    seen = pd.read_csv(results / "trajectories.csv")
    assert walkers == set(seen.loc[seen["type"] == "pedestrian", "id"])
    (way,) = json.loads((results / "scene.json").read_text())["ways"]
    assert [place["lane"] for place in way["crossings"]] == [":zebra_c0_0"]


def test_a_journal_keeps_what_the_judgement_needs(made) -> None:
    _, folder, result = made
    rescued = recover(
        folder / "journal",
        Verdict(139, True, False, "SIGSEGV", Pulse(Phase.SUMO, 100, 5.0, 0, 0), "", ""),
    ).result
    assert rescued is not None
    assert rescued.summary["encounters"] == result.summary["encounters"]
    pd.testing.assert_frame_equal(rescued.ledger, result.ledger)


def test_a_note_says_what_the_ledger_says_with_a_twin_too(tmp_path: Path) -> None:
    result = run(tmp_path, "none", twin=True)
    counts = result.ledger.loc[result.ledger["violation"], "kind"].value_counts()
    (note,) = (text for text in result.remarks if "law of the road" in text)
    assert len(counts)
    assert all(f"{number} x {kind}" in note for kind, number in counts.items())
    assert note.count(" x ") == len(counts)
    told = json.loads((tmp_path / "results" / "manifest.json").read_text())["remarks"]
    assert told == list(result.remarks)


def test_where_the_law_has_no_say_the_files_are_the_same_as_ever(tmp_path: Path) -> None:
    checked = preflight(*load([as_layer({"time_limit": 0.2, "crowd": {"pedestrians": 3}})]))
    result = run_checked(checked, Destination(tmp_path / "plaza", pictures=False))
    assert not {column.name for column in LAW_FIELDS} & set(result.summary)
    assert not set(LAW) & {path.name for path in (tmp_path / "plaza").iterdir()}
    assert "ways" not in json.loads((tmp_path / "plaza" / "scene.json").read_text())


def test_the_ego_stops_for_a_person_who_reaches_a_crossing_late() -> None:
    """In this drive a plan once led half a metre beyond the place to stop at, onto the crossing."""
    checked = preflight(*load([as_layer({"scenario": "junction", "seed": 123})]))
    summary = simulate(checked).summary
    assert summary["completed"]
    assert summary["encounters"] > 0
    assert (summary["failures_to_yield"], summary["blocked_crossings"]) == (0, 0)
