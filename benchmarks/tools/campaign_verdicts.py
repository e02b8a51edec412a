"""What a case of the campaign came to: civil, or one of the ways not to be."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from campaign_kinds import Case
    from campaign_nursery import Ended

TABLES: Final = ("runs", "cells", "levels", "comparison", "situations", "failures")
BAD: Final = ("traceback", "native", "hang", "different", "nonsense", "mute", "noise", "wrong")
_LONGEST: Final = 1500  # characters of a clear line
_FINDINGS: Final = ("doctor", "fmu", "study")  # they may say on a whole screen what is wrong
_FORCED: Final = ("run", "study", "validate", "calibrate", "rerun", "recover")  # have --force
_INFINITY: Final = re.compile(rb"(?<=,)-?inf(?=[,\r\n])")
_STEERING: Final = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
_TRACEBACK: Final = "Traceback (most recent call last)"
_LIMIT: Final = 120  # [s] for a case that is typed again


@dataclass(frozen=True)
class Verdict:
    """What a case came to.

    Attributes:
        number: of the case.
        kind: of the case.
        outcome: civil: "fine", "refused", "recomputed" (and said so), "told" (native code ended
            the run, and one line says so). Not civil: "traceback"; "native": ended by a signal
            without a line; "hang"; "different": other tables without a word; "nonsense": infinite
            numbers in tables; "mute": failed without its one line; "noise": more than that, or what
            no terminal should be sent; "wrong": not what the case expects.
        code: of the exit.
        seconds: it took.
        mutations: what was done to which file.
        line: what was said.
        command: to be typed in the case's folder.
    """

    number: int
    kind: str
    outcome: str
    code: int
    seconds: float
    mutations: str
    line: str
    command: str

    @property
    def bad(self) -> bool:
        """Whether it is not civil."""
        return self.outcome in BAD


def judge(case: Case, ended: Ended, seconds: float, original: Path | None) -> Verdict:
    """The verdict on a case.

    Args:
        case: that was typed.
        ended: how it ended.
        seconds: it took.
        original: of a study that was resumed, the folder before it was mutated.
    """
    outcome = _outcome(case, ended, original)
    line = ended.err.strip() or ended.out.strip()[-300:]
    if outcome not in BAD and case.expected.broken(ended.code, ended.err):
        outcome = "wrong"
    if outcome == "native":
        code, line = _typed_again(case)
        outcome = "told" if code > 0 and _is_one_line(line) else "native"
    command = shlex.join(["giveway", *map(str, case.words)])
    return Verdict(
        case.number,
        case.kind,
        outcome,
        ended.code,
        round(seconds, 2),
        case.mutations,
        line[-2 * _LONGEST :],
        command,
    )


def _outcome(case: Case, ended: Ended, original: Path | None) -> str:
    if ended.hung:
        return "hang"
    if ended.code < 0:
        return "native"
    if _TRACEBACK in ended.err + ended.out:
        return "traceback"
    if _STEERING.search(ended.out):
        return "noise"
    notes = ended.err.strip()
    if ended.code == 0:
        if not all(map(_is_note, notes.splitlines())):
            return "noise"
        if case.words[0] == "run" and _holds_infinity(case.folder / "out"):
            return "nonsense"
        if original is None:
            return "fine"
        if notes:
            return "recomputed" if _same_tables(original, case.folder / "out") else "different"
        return "fine" if _same_tables(original, case.folder / "out") else "different"
    if not notes:
        return "refused" if case.words[0] in _FINDINGS and ended.out.strip() else "mute"
    last = [line for line in notes.splitlines() if not _is_note(line)]
    return "refused" if _is_one_line("\n".join(last)) else "noise"


def _is_note(line: str) -> bool:
    return line.startswith("note: ") and line.isprintable()


def _holds_infinity(results: Path) -> bool:
    """Whether a table of a run has an infinite number, which no simulation means."""
    tables = [file.read_bytes() for file in results.glob("*.csv")]
    return any(_INFINITY.search(table) for table in tables)


def _is_one_line(text: str) -> bool:
    """Whether ``text`` is one error that a terminal can show and a person can read."""
    return text.startswith("error: ") and text.isprintable() and len(text) <= _LONGEST


def _same_tables(one: Path, other: Path) -> bool:
    names = [*(f"{name}.csv" for name in TABLES), "study.toml", "manifest.json"]
    return all((one / n).read_bytes() == (other / n).read_bytes() for n in names)


def _typed_again(case: Case) -> tuple[int, str]:
    """Exit code and words of a case as a user types it: in a process that giveway isolates."""
    command = [sys.executable, "-m", "giveway", *map(str, case.words), "--force"]
    if case.words[0] not in _FORCED:
        command.pop()
    try:
        done = subprocess.run(
            command,
            cwd=case.folder,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return -1, f"hangs for {_LIMIT} s"
    return done.returncode, done.stderr.strip()


def read_verdicts(file: Path) -> dict[int, Verdict]:
    """The verdicts so far by number."""
    return {verdict.number: verdict for verdict in read_lines(file, Verdict)}


def read_lines(file: Path, kind: Callable[..., Any]) -> Iterator[Any]:
    """Yield what the lines of a file of JSON hold; the last line may be torn."""
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else []:
        with suppress(ValueError):
            yield kind(**json.loads(line))
