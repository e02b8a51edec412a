"""Runs whose rows are journalled: what is read back, and what is said when they cannot be kept."""

from pathlib import Path

from giveway.api import run_checked
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.journal.journal import ROWS_FILE
from giveway.processes.heartbeat import Phase, Pulse
from giveway.processes.supervisor import Verdict
from giveway.recovery import recover
from giveway.run_data.progress import Ending

SHORT = {"crowd": {"pedestrians": 3}, "ego": {"travel_distance": 8.0}}


def test_a_journal_that_cannot_be_written_is_told_to_the_user(tmp_path: Path) -> None:
    result = run_checked(preflight(*load([as_layer(SHORT)])), journal=tmp_path / "gone")
    assert result.completed
    assert any("the journal cannot be written" in remark for remark in result.remarks)
    assert result.manifest["remarks"] == list(result.remarks)


def test_after_a_crash_an_ego_that_had_arrived_has_arrived(tmp_path: Path) -> None:
    far = {"ego": {"id": "far", "depart_position": 12.0, "travel_distance": 30.0}}
    egos = ({"ego": {"id": "near"}}, far)
    result = run_checked(preflight(*load([as_layer(SHORT | {"egos": egos})])), journal=tmp_path)
    arrived = [ego for ego in result.egos if ego.id == "near"]
    assert len(arrived[0].track.time) < len(result.time)
    rows = tmp_path / ROWS_FILE
    with rows.open("r+b") as file:
        file.truncate(rows.stat().st_size * 8 // 10)
    pulse = Pulse(Phase.SUMO, 100, 5.0, 0, 0)
    rescued = recover(tmp_path, Verdict(139, True, False, "SIGSEGV", pulse, "", "")).result
    assert rescued is not None
    assert rescued.ending is Ending.CRASHED
    assert {ego.id: ego.ending for ego in rescued.egos} == {
        "near": Ending.COMPLETED,
        "far": Ending.CRASHED,
    }


def test_after_a_crash_it_is_still_known_who_people_were(tmp_path: Path) -> None:
    crowd = {"pedestrians": 12, "groups": 0.8, "people": {"elderly": 0.5}}
    checked = preflight(*load([as_layer(SHORT | {"crowd": crowd})]))
    result = run_checked(checked, journal=tmp_path)
    pulse = Pulse(Phase.SUMO, 20, 1.0, 0, 0)
    rescued = recover(tmp_path, Verdict(139, True, False, "SIGSEGV", pulse, "", "")).result
    assert rescued is not None
    told = rescued.pedestrians[["id", "kind", "group"]]
    assert told.equals(result.pedestrians[["id", "kind", "group"]])
    assert set(told["kind"]) == {"adult", "elderly"}
    assert (told["group"] != "").any()
