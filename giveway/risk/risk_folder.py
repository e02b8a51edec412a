"""A risk's folder as it is read: its definition, its runs, its estimate."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from giveway.config.files.layers import Layer
from giveway.errors import ResultsError
from giveway.gate import DEFINITIONS, MANIFEST, read_text
from giveway.risk.definition import parse_risk
from giveway.risk.estimators import Estimate, SobolIndex
from giveway.risk.plan import Findings, RiskPlan, RiskRun, batches, plan_risk
from giveway.studies.folder.folder_contents import read_manifest, require_definition
from giveway.studies.folder.store import RecordStore
from giveway.studies.record import RunRecord

RISK_FILE = DEFINITIONS["risk"]


class RiskFolder:
    """The files that a risk has written so far.

    Args:
        path: Path of the folder.
        plan: Plan of the risk, or None to make it from the folder.
        trusted: Code, as module:Class, that the risk may import.

    Attributes:
        path: Path of the folder.
        plan: Plan of the risk.

    Raises:
        ResultsError: there is no risk.
        GivewayError: the risk cannot be planned as it was.
    """

    def __init__(
        self, path: Path, plan: RiskPlan | None = None, trusted: Collection[str] = ()
    ) -> None:
        self.path = path
        try:
            manifest = read_manifest(path)
            text = read_text(path / RISK_FILE)
            identity, digest = manifest["identity"], manifest["cells"][0]["digest"]
        except (OSError, KeyError, IndexError, TypeError):
            raise ResultsError(
                f"{path}: no risk there ({RISK_FILE} and {MANIFEST} that giveway wrote); name the "
                "folder that giveway risk printed"
            ) from None
        require_definition(path, manifest)
        origin = str(path / RISK_FILE)
        plan = plan or plan_risk(parse_risk(text, origin, path.absolute()), origin, trusted)
        self.plan = replace(plan, digest=digest)  # of the code that made the runs
        self._store = RecordStore(path, identity)

    @cached_property
    def _replayed(self) -> tuple[list[tuple[RiskRun, RunRecord]], Findings | None]:
        """Return the finished runs in order, and the findings if all are there."""
        found: list[tuple[RiskRun, RunRecord]] = []
        asking = batches(self.plan)
        try:
            runs = next(asking)
            while True:
                records = [self._store.get(run.key) for run in runs]
                there = [record for record in records if record is not None]
                found += [
                    (run, record.called(run.id))
                    for run, record in zip(runs, records, strict=True)
                    if record is not None
                ]
                if len(there) < len(runs):
                    return found, None
                runs = asking.send(there)
        except StopIteration as end:
            return found, end.value

    @property
    def runs(self) -> list[tuple[RiskRun, RunRecord]]:
        """The runs of the estimate with their records, in the order of their numbers."""
        return self._replayed[0][: self.estimate.runs]

    @property
    def estimate(self) -> Estimate:
        """The estimate.

        Raises:
            ResultsError: runs are missing.
        """
        return self._findings.estimate

    @property
    def indices(self) -> tuple[SobolIndex, ...]:
        """The Sobol indices of the criticality.

        Raises:
            ResultsError: runs are missing.
        """
        return self._findings.indices

    @property
    def _findings(self) -> Findings:
        made, findings = self._replayed
        if findings is None:
            raise ResultsError(
                f"{self.path}: runs are missing, {len(made):,} are there; go on with giveway "
                "risk and --resume"
            )
        return findings

    def record(self, run: str) -> RunRecord | None:
        """Return the record of a run.

        Raises:
            ResultsError: this risk has no such run.
        """
        return self._run(run)[1]

    def key_of(self, run: str) -> str:
        """Return the key of a run's record.

        Raises:
            ResultsError: this risk has no such run.
        """
        return self._run(run)[0].key

    def layer_of(self, run: str) -> Layer:
        """Return the settings of a run.

        Raises:
            ResultsError: this risk has no such run.
        """
        return self.plan.layer(self._run(run)[0].vector)

    def _run(self, run: str) -> tuple[RiskRun, RunRecord]:
        made = self._replayed[0]
        for one, record in made:
            if one.id == run:
                return one, record
        raise ResultsError(
            f"run '{run}': not in {self.path}; expected r<number>, r1 to r{len(made)}: see runs.csv"
        )


def is_risk(path: Path) -> bool:
    """Return whether a folder holds a risk."""
    return (path / RISK_FILE).is_file()
