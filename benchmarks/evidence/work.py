"""What is run for a page: a study, or a command of a benchmark. Both go on where they ended."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from giveway.studies.definition import changed
from giveway.studies.study import run_study
from giveway.studies.study_options import StudyOptions
from giveway.studies.varying import study_of

BENCHMARKS = Path(__file__).resolve().parents[1]
QUICK = 3
"""Number of seeds of a quick study: enough to show that its tables can be made."""


class Study(NamedTuple):
    """A study and its sample.

    Attributes:
        definition: Name of a bundled study, or the keys of a study file.
        runs: Number of seeds of each cell.
        first_seed: First of them; 551 on were never looked at while the default was tuned.
        twin: Whether people's delays are asked for; False saves the counterfactual runs.
        changes: Other keys of the study, like ``only`` and ``comparison``.
    """

    definition: str | Mapping[str, Any]
    runs: int
    first_seed: int = 551
    twin: bool = False
    changes: Mapping[str, Any] = {}

    @property
    def sample(self) -> str:
        """Words for the seeds."""
        return f"seeds {self.first_seed} to {self.first_seed + self.runs - 1}"

    @property
    def name(self) -> str:
        """Name of the study."""
        return self.definition if isinstance(self.definition, str) else self.definition["name"]

    def make(self, folder: Path, jobs: int, quick: bool, _data: Path | None = None) -> Path:
        """Run what is not in the folder yet.

        Returns:
            Folder of the study.
        """
        wanted, origin = study_of(self.definition)
        settings = {
            "replications": QUICK if quick else self.runs,
            "first_seed": self.first_seed,
            "run": dict(wanted.run) | {"twin": self.twin},
        }
        there = (folder / "manifest.json").exists()
        run_study(
            changed(wanted, settings | dict(self.changes), origin),
            origin,
            folder,
            StudyOptions(jobs=jobs, resume=there),
            None,
        )
        return folder


class Command(NamedTuple):
    """A benchmark that prints what a page shows.

    Attributes:
        words: File in benchmarks/ and its arguments; ``{out}`` is a path that is kept, ``{data}``
            data outside the repository.
        sample: Words for what is measured.
        quick: Arguments of a short run, instead.
    """

    words: str
    sample: str = ""
    quick: str = ""

    @property
    def name(self) -> str:
        """Name of the benchmark."""
        return Path(self.words.split()[0]).stem

    def make(self, folder: Path, jobs: int, quick: bool, data: Path | None = None) -> Path:
        """Run the command unless the folder has what it printed.

        Returns:
            File of what was printed.

        Raises:
            RuntimeError: The command failed.
        """
        printed = folder / "printed.md"
        if printed.exists():
            return printed
        folder.mkdir(parents=True, exist_ok=True)
        script, *words = self.words.split()
        if quick:
            words = self.quick.split()
        if data is None and "{data}" in self.words:
            raise RuntimeError(f"benchmarks/{script}: expected --data with its input")
        words = [word.format(out=folder / "out", jobs=jobs, data=data) for word in words]
        done = subprocess.run(
            [sys.executable, BENCHMARKS / script, *words],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise RuntimeError(f"benchmarks/{script} {' '.join(words)}: {last}")
        printed.write_text(done.stdout.rstrip("\n") + "\n", encoding="utf-8")
        return printed
