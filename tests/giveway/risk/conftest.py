"""A small risk that is really run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from support.studies import InThisProcess

from giveway.risk.definition import make_risk
from giveway.risk.session import run_risk
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
