"""A small risk that is really run."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from support.studies import InThisProcess

from giveway.risk.definition import make_risk
from giveway.risk.plan import batches, plan_risk
from giveway.risk.session import run_risk
from giveway.studies.record import RunRecord
from giveway.studies.study_options import StudyOptions

HIT_AT_ONCE = {
    "name": "small",
    "runs": 8,
    "run": {
        "time_limit": 1.0,
        "controller": "pid-paper",
        "ego": {"initial_speed": 8.0},
        "crowd": {"pedestrians": 2, "spawn_area": [3.5, -2, 9, 1], "walk": [0, 5]},
    },
    "inputs": {"vehicle.mass": {"normal": [1000, 50]}},
}


class OptionsHere(StudyOptions):
    """Options of a risk whose runs are made in this process."""

    def executor(self) -> Any:
        return InThisProcess() if self.jobs is None else super().executor()


@pytest.fixture(scope="session")
def risk_of():
    """Runs a risk: (folder, **changes) -> RiskFolder; ``options`` are those of the computation."""

    def run(out, options=None, watcher=None, **changes):
        wanted = make_risk(HIT_AT_ONCE | changes, "mine")
        return run_risk(wanted, "mine", out, options or OptionsHere(), watcher)

    return run


@pytest.fixture(scope="session")
def small_risk(risk_of, tmp_path_factory):
    """A risk of eight runs, some of which have a contact."""
    return risk_of(tmp_path_factory.mktemp("risk") / "out")


@pytest.fixture
def resumed():
    return replace(OptionsHere(), resume=True)


@pytest.fixture
def known_risk(tmp_path):
    """Returns a risk whose runs have a formula: (method, runs, **changes) -> folder.

    Runs are the worse, the faster the ego and the heavier the car; nothing else matters.
    """

    def make(method="monte-carlo", runs=1500, **changes):
        inputs = {
            "ego.initial_speed": {"uniform": [1.0, 8.0]},
            "vehicle.mass": {"normal": [1000, 50]},
            "crowd.preset": {"choice": ["MIXED", "SIM"]},
        }
        values = HIT_AT_ONCE | {"inputs": inputs, "method": method, "runs": runs} | changes
        plan = plan_risk(make_risk(values, "mine"), "mine")
        asking, made = batches(plan), []
        try:
            batch = next(asking)
            while True:
                records = [_by_formula(run) for run in batch]
                made += zip(batch, records, strict=True)
                batch = asking.send(records)
        except StopIteration as end:
            found = end.value
        used = made[: found.estimate.runs]
        return SimpleNamespace(
            path=tmp_path, plan=plan, runs=used, estimate=found.estimate, indices=found.indices
        )

    return make


def _by_formula(run):
    beyond = 0.8 * float(run.vector[1]) + 0.6 * float(run.vector[2]) - 1.3
    row = {
        "ego": "ego",
        "ending": "completed",
        "travelled_distance": 50.0,
        "minimum_clearance": max(0.0, -beyond),
        "frontal_impact_speed": 10.0 * beyond if beyond >= 0.0 else None,
        "adult_impact_speed": 10.0 * beyond if beyond >= 0.0 else None,
    }
    return RunRecord(run.id, run.key, "completed", rows=(row,))
