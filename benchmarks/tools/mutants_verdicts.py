"""One mutant and the tests that execute its function: who finds it?"""

from __future__ import annotations

import json
import re
from contextlib import ExitStack
from dataclasses import dataclass, field
from math import inf
from time import monotonic
from typing import TYPE_CHECKING, Final

from mutants_functions import compiled_with, executors
from mutants_tests import FAILED, TIMEOUT

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from mutants_drawn import Mutant, Placed
    from mutants_functions import Function
    from mutants_tests import Mapped, Outcome, Place

FOUND: Final = ("killed", "broken", "timeout")

_OPEN: Final = ("survived", "unexecuted", "unfinished")
_BATCH: Final = 30.0  # [s] of tests that share one start of the interpreter
_SLOWER: Final = 3.0  # so many times the seconds of the map, and
_PATIENCE: Final = 60.0  # [s] more are granted
_COMPILING: Final = 240.0  # [s] more where kernels are compiled anew
_NOT_COLLECTED: Final = (2, 4)  # pytest's exit codes


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant.

    Attributes:
        mutant: its name.
        verdict: one of the words of mutants.py.
        by: the test that found it.
        seconds: spent on it, in all calls.
        passed: test files that do not find it.
        line: the changed line, should it not be the drawn one.
        ignored: tests that failed with the mutant, and then without it.
    """

    mutant: str
    verdict: str
    by: str = ""
    seconds: float = 0.0
    passed: list[str] = field(default_factory=list)
    line: str = ""
    ignored: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Trial:
    """All that is known before a mutant is tried."""

    mutant: Mutant
    placed: Placed
    functions: Sequence[Function]
    mapped: Mapping[str, Mapped]
    limit: float
    guessed: bool = False  # nobody knows how long the tests take

    @property
    def recompiles(self) -> bool:
        """Whether numba compiles kernels anew: there are some in the file that is changed."""
        file = self.placed.function.file
        return any(f.compiled and f.line and f.file == file for f in self.functions)

    def files(self, tree: Path) -> list[str]:
        """Test files that execute the function: those that name it first, then the shortest."""
        keys = executors(self.placed.function, self.functions)
        able = [m for m in self.mapped.values() if m.passed and not keys.isdisjoint(m.functions)]
        names = "|".join(re.escape(name) for name in self.placed.function.name.split("."))
        naming = re.compile(rf"\b({names})\b")

        def order(mapped: Mapped) -> tuple[bool, float]:
            named = naming.search((tree / mapped.file).read_text()) is not None
            return not named, mapped.seconds

        return [mapped.file for mapped in sorted(able, key=order)]

    def continues(self, before: Verdict, tree: Path) -> bool:
        """Whether there is anything to do that was not done before."""
        left = set(self.files(tree)) - set(before.passed)
        return before.verdict in _OPEN and before.seconds < self.limit and bool(left)


def read_verdicts(folder: Path) -> dict[str, Verdict]:
    """The verdicts of a campaign so far."""
    results = folder / "results.jsonl"
    lines = results.read_text().splitlines() if results.exists() else []
    found = [Verdict(**json.loads(line)) for line in lines]
    return {verdict.mutant: verdict for verdict in found}  # the last one of each


def try_mutant(here: Place, trial: Trial, before: Verdict | None) -> Verdict:
    """Let the tests loose on a mutant, until the first failure or for ``trial.limit`` seconds.

    Args:
        here: a private copy of the tree; the mutant is gone from it afterwards.
        trial: the mutant.
        before: what earlier calls found out.
    """
    passed = [] if before is None else list(before.passed)
    spent = 0.0 if before is None else before.seconds
    ignored = [] if before is None else list(before.ignored)
    start = monotonic()
    word, by = "", ""
    files = [f for f in trial.files(here.tree) if f not in passed]
    for batch in _batches(files, trial.mapped):
        left = trial.limit - spent - (monotonic() - start)
        word, by = _try_tests(here, trial, batch, left, ignored)
        if word:
            break
        passed += batch
    seconds = round(spent + monotonic() - start, 1)
    line = "" if trial.placed.exact else trial.placed.site.line
    word = word or ("survived" if passed else "unexecuted")
    return Verdict(trial.mutant.name, word, by, seconds, passed, line, ignored)


def _try_tests(
    here: Place, trial: Trial, files: Sequence[str], left: float, ignored: list[str]
) -> tuple[str, str]:
    """The verdict and the test that spoke it; nothing, if these files pass."""
    expected = sum(trial.mapped[f].seconds for f in files)
    granted = _SLOWER * expected + _PATIENCE + (_COMPILING if trial.recompiles else 0.0)
    granted = inf if trial.guessed else granted
    end = monotonic() + left
    while (remaining := end - monotonic()) > expected:
        tests = [*files, *(f"--deselect={test}" for test in ignored)]
        outcome = _with_mutant(here, trial, tests, min(granted, remaining))
        if outcome.passed:
            return "", ""
        if outcome.code == TIMEOUT:
            return ("timeout", files[0]) if granted < remaining else ("unfinished", "")
        test = outcome.first_failure()
        if outcome.code in _NOT_COLLECTED:
            return "broken", test
        if "::" not in test or here.pytest([test], min(granted, trial.limit)).code != FAILED:
            return "killed", test
        ignored.append(test)
    return "unfinished", ""


def _with_mutant(here: Place, trial: Trial, tests: Sequence[str], limit: float) -> Outcome:
    function = trial.placed.function
    source = (here.tree / function.file).read_bytes()
    kernels = None
    with ExitStack() as stack:
        if trial.recompiles:
            stale = compiled_with(function, trial.functions) if function.compiled else []
            kernels = stack.enter_context(here.kernels_without(stale))
        stack.enter_context(here.changed(function.file, trial.placed.site.applied(source)))
        return here.pytest(tests, limit, kernels=kernels)


def _batches(files: Sequence[str], mapped: Mapping[str, Mapped]) -> Iterator[list[str]]:
    """Test files that run in one pytest: as many as take half a minute together, or one."""
    batch: list[str] = []
    seconds = 0.0
    for file in files:
        if batch and seconds + mapped[file].seconds > _BATCH:
            yield batch
            batch, seconds = [], 0.0
        batch.append(file)
        seconds += mapped[file].seconds
    if batch:
        yield batch
