"""The twin of a run, through the real SUMO, FMU and solver."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING

from giveway.api import run_checked, simulate
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.counterfactual.follow_up import Followed
from giveway.cosimulation.preflight import preflight
from giveway.errors import SumoError
from giveway.processes.heartbeat import Phase, Pulse
from giveway.processes.interrupts import DeferredInterrupt
from giveway.processes.supervisor import Verdict
from giveway.recovery import recover
from giveway.results.folder import Destination
from giveway.run_data.progress import Ending

if TYPE_CHECKING:
    from pathlib import Path

OPEN = {"controller": "pid-tuned", "crowd": {"pedestrians": 10}, "seed": 3}
STREET = {"scenario": "street", "controller": "pid-tuned", "crowd": {"pedestrians": 10}}


def columns(file: Path) -> dict[str, list[str]]:
    with file.open(newline="") as text:
        names, *rows = csv.reader(text)
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def test_a_twin_that_fails_or_dies_loses_no_row_of_its_run(
    run_once, monkeypatch, tmp_path, refused
):
    def fail(*_: object) -> None:
        raise SumoError("SUMO failed at 3.0 s")

    whole = run_once(twin=True, **OPEN)
    journal = tmp_path / "journal"
    journal.mkdir()
    monkeypatch.setattr("giveway.api.simulation.twin_of", fail)
    checked = preflight(*load([as_layer(OPEN | {"twin": True})]))
    with refused(SumoError, "in the twin", "SUMO failed at 3.0 s") as caught:
        run_checked(checked, Destination(tmp_path / "kept", pictures=False), journal=journal)
    partial = caught.value.result
    assert partial.summary == {name: whole.summary[name] for name in partial.summary}
    assert columns(tmp_path / "kept" / "pedestrians.csv")
    pulse = Pulse(Phase.SUMO, 100, 5.0, 0, 0)
    rescued = recover(journal, Verdict(139, True, False, "SIGSEGV", pulse, "", "")).result
    assert rescued is not None
    assert rescued.egos[0].ending is Ending.COMPLETED
    assert rescued.ego.equals(whole.ego)
    assert rescued.effect is None


def test_a_user_who_ends_it_in_the_twin_keeps_the_run(monkeypatch):
    class AfterTheRun(DeferredInterrupt):
        requested = False

    interrupt = AfterTheRun()
    follow = Followed.follow

    def ending(*arguments: object) -> bool:
        interrupt.requested = True
        return follow(*arguments)

    monkeypatch.setattr(Followed, "follow", ending)
    result = simulate(preflight(*load([as_layer(STREET | {"twin": True})])), interrupt=interrupt)
    assert result.ending is Ending.INTERRUPTED
    assert result.egos[0].ending is Ending.COMPLETED
    assert result.effect is None
