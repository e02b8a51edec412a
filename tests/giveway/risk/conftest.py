"""A small risk that is really run."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from support.risks import HIT_AT_ONCE
from support.risks import known_risk as by_formula
from support.studies import InThisProcess

from giveway.risk.definition import make_risk
from giveway.risk.session import run_risk
from giveway.studies.study_options import StudyOptions


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
    """Returns a risk whose runs have a formula: (method, runs, **changes) -> folder."""
    return partial(by_formula, tmp_path)
