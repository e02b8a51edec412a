"""The verdict on a case of the campaign of signals."""

from __future__ import annotations

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

    from signals_commands import Command

CASE: Final = "SIGNALS_CASE"  # Environment variable that marks the processes of a case
OUTCOMES: Final = (
    *("early", "late", "line", "died", "finished"),
    *("traceback", "hang", "code", "mute", "noise", "process", "scratch", "torn", "lost"),
)
BAD: Final = OUTCOMES[5:]
_GRACE: Final = 2.0  # Time [s] within which the other processes of a command must have ended
_TELLTALE: Final = ("Traceback (most recent call last)", "ImportError", "Exception ignored")
_PARTIAL: Final = (".new", ".tmp", ".part")
_ENDS: Final = {".html": b"</html>", ".xml": b">", ".png": b"IEND\xaeB`\x82"}


@dataclass(frozen=True)
class Ended:
    """The end of a command.

    Attributes:
        code: Return code of :mod:`subprocess`: minus the signal, or the exit code.
        hung: True if it had to be killed at the limit.
        sent: Time [s] from the start to the signal; 0 if it had ended before.
        first: Time [s] from the start to giveway's first line; inf if it was not reached.
        seconds: Time [s] from the start to the end.
        out: Standard output.
        err: Standard error.
        left: Processes that were there after the end.
    """

    code: int
    hung: bool
    sent: float
    first: float
    seconds: float
    out: str
    err: str
    left: tuple[str, ...]


@dataclass(frozen=True)
class Verdict:
    """The verdict on a case.

    Attributes:
        command: Name of the command.
        number: Number of the case.
        outcome: Right: "line", exit code 128 + n with one line; "died", death by the signal with
            its output printed and nothing left, while Python takes itself apart; "finished", the
            regular end; "late", the command had ended before the signal; "early", not judged since
            the signal came before giveway's first line. Not right: "traceback"; "hang"; "code",
            another exit code; "mute", no line; "noise", more than one; "process", a process is
            left; "scratch", a temporary folder is left; "torn", a file is half written; "lost",
            recorded rows cannot be read.
        signal: Signal and whom it was sent to.
        sent: Time [s] from the start to the signal.
        seconds: Time [s] from the start to the end.
        code: Return code.
        line: Standard error.
        why: Reason in words.
    """

    command: str
    number: int
    outcome: str
    signal: str
    sent: float
    seconds: float
    code: int
    line: str
    why: str

    @property
    def bad(self) -> bool:
        """Whether the case is not right."""
        return self.outcome in BAD


def judge(
    name: str, number: int, ended: Ended, folder: Path, command: Command, sent: int, signal: str
) -> Verdict:
    """Return the verdict on a case.

    Args:
        name: Name of the command.
        number: Number of the case.
        ended: End of the command.
        folder: Folder of the case.
        command: Command that was run.
        sent: Number of the signal.
        signal: Signal in words.
    """
    outcome, why = _outcome(ended, folder, command, sent)
    line = ended.err.strip()[-1500:]
    times = round(ended.sent, 4), round(ended.seconds, 3)
    return Verdict(name, number, outcome, signal, *times, ended.code, line, why)


def _outcome(ended: Ended, folder: Path, command: Command, number: int) -> tuple[str, str]:
    if not ended.sent:
        return "late", ""
    if ended.sent < ended.first:
        return "early", ""
    if ended.hung:
        return "hang", "killed at the limit"
    text = ended.err + ended.out
    if found := [word for word in _TELLTALE if word in text]:
        return "traceback", found[0]
    if ended.left:
        return "process", ", ".join(ended.left)
    if scratch := sorted(path.name + "/" * path.is_dir() for path in (folder / "tmp").iterdir()):
        return "scratch", ", ".join(scratch)
    if torn := next(_torn(folder, command), ""):
        return "torn", torn
    lines = [line for line in ended.err.splitlines() if not line.startswith("note: ")]
    if ended.code == 0:
        return ("noise", "an error although all is done") if lines else ("finished", "")
    if ended.code == -number:
        if lines:
            return "noise", "a line, and death by the signal"
        return ("died", "") if ended.out.strip() else ("mute", "nothing is said or printed")
    if ended.code != 128 + number:
        return "code", f"expected {128 + number}"
    if not lines:
        return "mute", "no line"
    if len(lines) > 1 or not lines[0].startswith("error: "):
        return "noise", f"{len(lines)} lines"
    return _recorded(lines[0], folder)


def _recorded(line: str, folder: Path) -> tuple[str, str]:
    """Return the outcome by what the line says of recorded rows."""
    if "rows up to then are in" in line and not _rows(folder / "out"):
        return "lost", "the line names rows that are not there"
    return "line", ""


def _rows(results: Path) -> int:
    table = results / "ego.csv"
    return len(table.read_text().splitlines()) - 1 if table.is_file() else 0


def _torn(folder: Path, command: Command) -> Iterator[str]:
    """Yield the files that are not whole."""
    for path in folder.rglob("*"):
        if path.suffix in _PARTIAL and path.is_file() and (folder / "tmp") not in path.parents:
            yield f"{path.name} is left"
    for name in command.pages:
        page = folder / name
        if page.is_file() and not _is_whole(page):
            yield f"{name} is cut"
    results = folder / "out"
    if results.is_dir() and command.results == "run":
        yield from _torn_run(results)
    if results.is_dir() and command.results == "study":
        yield from _torn_study(results)


def _is_whole(page: Path) -> bool:
    content = page.read_bytes().rstrip()
    if page.suffix == ".toml":
        try:
            return bool(tomllib.loads(content.decode()))
        except ValueError:
            return False
    return content.endswith(_ENDS[page.suffix])


def _torn_run(results: Path) -> Iterator[str]:
    """Yield the reason why a results folder is not that of a run, or is not sealed."""
    from giveway.errors import GivewayError
    from giveway.replays.run_folder import RunFolder

    try:
        note = RunFolder.read(results).seal_note
    except GivewayError as error:
        yield str(error)
    else:
        if note:
            yield note


def _torn_study(results: Path) -> Iterator[str]:
    """Yield the records of a study that are not whole."""
    for record in results.glob("records/*/*.json"):
        try:
            json.loads(record.read_text())
        except ValueError:
            yield f"{record.name} is cut"
    for table in results.glob("*.csv"):
        if not table.read_bytes().endswith(b"\n"):
            yield f"{table.name} is cut"


def left_processes(name: str) -> tuple[str, ...]:
    """Return the command lines of the processes of a case that do not end soon."""
    end = monotonic() + _GRACE
    while found := tuple(_processes(name)):
        if monotonic() > end:
            return found
        sleep(0.02)
    return ()


def _processes(name: str) -> Iterator[str]:
    mark = f"{CASE}={name}".encode()
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if mark in (entry / "environ").read_bytes().split(b"\0"):
                words = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode().strip()
                yield words[:200] or entry.name
        except OSError:  # it has ended, or belongs to somebody else
            continue
