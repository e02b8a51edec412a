"""Test files run one by one in a private copy of a tree, and which functions each executes."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import uuid
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Final

import psutil
from filelock import FileLock, Timeout
from mutants_functions import PACKAGES, Function, functions_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

TIMEOUT: Final = 124  # the exit code of tests that were stopped, as of coreutils' timeout
FAILED: Final = 1  # pytest's exit code
NO_TESTS: Final = 5  # pytest's exit code where nothing is left to run

_RECORDER: Final = Path(__file__).resolve().parent / "mutants_recorder"
_LEFT_OUT: Final = (".git", ".venv", "__pycache__", ".pytest_cache", ".hypothesis", ".*_cache")
_QUICK, _SLOW = 5.0, 25.0  # [s] roughly, of a test file that has not been mapped
_MARK: Final = "MUTANTS_TOKEN"  # in the environment of all processes that come from one of ours


@dataclass(frozen=True)
class Outcome:
    """How a pytest process ended.

    Attributes:
        code: its exit code.
        seconds: that it took.
        output: what it printed.
    """

    code: int
    seconds: float
    output: str

    @property
    def passed(self) -> bool:
        """Whether no test failed."""
        return self.code in (0, NO_TESTS)

    def first_failure(self) -> str:
        """The first test that failed, or what pytest said last."""
        for line in self.output.splitlines():
            if line.startswith(("FAILED ", "ERROR ")):
                return line.partition(" ")[2].partition(" - ")[0]
        return f"pytest died of signal {-self.code}" if self.code < 0 else self.last_line()

    def last_line(self) -> str:
        """What pytest said last."""
        return next((line for line in reversed(self.output.splitlines()) if line.strip()), "")


class Place:
    """A private copy of a tree, with a home, a temporary folder and caches of its own.

    It is kept from one call to the next: compiled kernels, FMUs and fonts are made once. It gets
    pytest's cache, too, in which tests keep their FMUs, so ``-p no:cacheprovider`` is not for us.
    """

    def __init__(self, tree: Path, folder: Path) -> None:
        self.folder = folder.resolve()
        self.tree = self.folder / "tree"
        self.kernels = self.folder / "kernels"
        self._token = uuid.uuid4().hex
        self._lock = self._own()
        if not self.tree.exists():
            unfinished = self.folder / "unfinished"
            shutil.rmtree(unfinished, ignore_errors=True)
            shutil.copytree(tree, unfinished, ignore=shutil.ignore_patterns(*_LEFT_OUT))
            unfinished.rename(self.tree)
        for name in ("home", "kernels", "functions"):
            (self.folder / name).mkdir(exist_ok=True)

    def _own(self) -> FileLock:
        self.folder.mkdir(parents=True, exist_ok=True)
        lock = FileLock(self.folder / "lock", timeout=0)
        try:
            lock.acquire()
        except Timeout:
            sys.exit(f"{self.folder}: another process works there; give another --place")
        return lock

    def pytest(
        self,
        tests: Sequence[str],
        limit: float,
        *,
        record: Path | None = None,
        kernels: Path | None = None,
    ) -> Outcome:
        """Run tests until the first failure; with ``record``, all of them.

        Args:
            tests: files or tests, as pytest names them.
            limit: [s] after which they are stopped.
            record: where to append the functions they execute.
            kernels: another folder for compiled kernels.
        """
        temporary = self.folder / "tmp"
        shutil.rmtree(temporary, ignore_errors=True)
        temporary.mkdir()
        path = [str(_RECORDER)] * (record is not None) + [str(self.tree)]
        environment = {
            **os.environ,
            **dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(temporary)),
            "HOME": str(self.folder / "home"),
            "NUMBA_CACHE_DIR": str(kernels or self.kernels),
            "PYTHONPATH": os.pathsep.join(path),
            _MARK: self._token,
        }
        environment = {k: v for k, v in environment.items() if not k.startswith("XDG_")}
        if record is not None:
            environment["MUTANTS_RECORD"] = str(record)
            environment["MUTANTS_FUNCTIONS"] = str(self.folder / "functions")
        options = ["-q", "-p", "no:xdist", "--tb=line", "-rfE", "--hypothesis-seed=0"]
        options += ["-x"] * (record is None)
        command = [sys.executable, "-m", "pytest", *options, *tests]
        start = monotonic()
        code, output = self._run(command, environment, limit)
        return Outcome(code, round(monotonic() - start, 2), output)

    def _run(
        self, command: Sequence[str], environment: dict[str, str], limit: float
    ) -> tuple[int, str]:
        printed = self.folder / "printed.txt"
        with printed.open("wb") as file:
            process = subprocess.Popen(
                command,
                cwd=self.tree,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                code = process.wait(limit)
            except subprocess.TimeoutExpired:
                code = TIMEOUT
            finally:
                self._end_all(process)
        return code, printed.read_text(errors="replace")

    def _end_all(self, process: subprocess.Popen[bytes]) -> None:
        """Kill the process and all that come from it, which bear our mark, wherever they are."""
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        for other in psutil.process_iter():
            with suppress(psutil.Error):
                if other.environ().get(_MARK) == self._token:
                    other.kill()

    @contextmanager
    def changed(self, file: str, content: bytes) -> Iterator[None]:
        """A source file has other content; bytes and time of change come back afterwards."""
        path = self.tree / file
        before, status = path.read_bytes(), path.stat()
        kept = self.folder / "changed.json"  # for the next call, should this one be killed
        times = (status.st_atime_ns, status.st_mtime_ns)
        kept.write_text(json.dumps([file, before.decode(), times]))
        path.write_bytes(content)
        try:
            yield
        finally:
            self.restore()

    def restore(self) -> None:
        """Give a changed source file its content back."""
        kept = self.folder / "changed.json"
        if kept.exists():
            file, before, times = json.loads(kept.read_text())
            (self.tree / file).write_bytes(before.encode())
            os.utime(self.tree / file, ns=tuple(times))
            kept.unlink()

    @contextmanager
    def kernels_without(self, functions: Sequence[Function]) -> Iterator[Path]:
        """A copy of the kernels' cache in which these are not: numba compiles them anew.

        Needed since numba looks at the file of a kernel only, and not at those it inlines.
        """
        copy = self.folder / "kernels-of-mutant"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.kernels, copy)
        for function in functions:
            for entry in copy.rglob(f"{Path(function.file).stem}.{function.name}-*"):
                entry.unlink()
        try:
            yield copy
        finally:
            shutil.rmtree(copy, ignore_errors=True)

    def prepare_recording(self) -> None:
        """Tell the recorder where in the private copy functions begin."""
        table: dict[str, dict[int, str]] = {}
        for function in functions_of(self.tree):
            if not function.compiled:
                path = str(self.tree / function.file)
                table.setdefault(path, {})[function.line] = function.key
        (self.folder / "functions" / "functions.json").write_text(json.dumps(table))


@dataclass(frozen=True)
class Mapped:
    """What a test file does with the tree as it is.

    Attributes:
        file: its path in the tree.
        passed: whether its tests pass; without the recorder, if they do not with it.
        seconds: that they take, the start of the interpreter included.
        end: what pytest said last.
        functions: keys of the functions it executes.
    """

    file: str
    passed: bool
    seconds: float
    end: str
    functions: list[str]


def test_files(tree: Path) -> list[str]:
    """All test files of a tree."""
    return [p.relative_to(tree).as_posix() for p in sorted((tree / "tests").rglob("test_*.py"))]


def map_file(place: Place, file: str, folder: Path, limit: float) -> Mapped:
    """Run a test file with the recorder, and keep what is learned in ``folder``."""
    name = file.replace("/", ".")
    record = folder.resolve() / f"{name}.txt"
    record.write_text("")
    outcome = place.pytest([file], limit, record=record)
    passed = outcome.passed
    if not passed and outcome.code != TIMEOUT:
        passed = place.pytest([file], limit).passed
    functions = sorted(set(record.read_text().split("\n")) - {""})
    mapped = Mapped(file, passed, outcome.seconds, outcome.last_line(), functions)
    (folder / f"{name}.json").write_text(json.dumps(asdict(mapped), indent=1))
    record.unlink()
    return mapped


def read_map(folder: Path) -> dict[str, Mapped]:
    """What is known of test files so far."""
    found = [Mapped(**json.loads(p.read_text())) for p in sorted(folder.glob("*.json"))]
    return {mapped.file: mapped for mapped in found}


def guess_map(tree: Path, function: Function, executors: set[str]) -> dict[str, Mapped]:
    """The test files that seem to concern a function, without a map.

    Those in the folder that mirrors its own, and those that mention its class or its own name, or
    import its module. The seconds are rough, but tell the slow ones from the quick.

    Args:
        tree: with the tests.
        function: that is to be executed.
        executors: what a recorder would see.
    """
    module = Path(function.file).with_suffix("")
    mirrored = f"tests/{module.parent.as_posix()}/"
    words = [re.escape(part) for part in function.name.split(".")[:2] if not part.startswith("__")]
    names = [*words[:1], re.escape(".".join(module.parts))]
    names += [rf"from {re.escape('.'.join(module.parts[:-1]))} import [^\n]*{module.name}"]
    naming = re.compile(rf"\b(?:{'|'.join(names)})\b")
    found = {}
    for file in test_files(tree):
        if file.startswith(mirrored) or naming.search((tree / file).read_text(encoding="utf-8")):
            seconds = _SLOW if file.startswith("tests/end_to_end") else _QUICK
            found[file] = Mapped(file, True, seconds, "", sorted(executors))
    return found


def fingerprint(tree: Path) -> str:
    """Changes with any source or test of the tree."""
    digest = hashlib.sha256()
    for package in (*PACKAGES, "tests"):
        for path in sorted((tree / package).rglob("*.py")):
            digest.update(f"{path.relative_to(tree)}\n".encode() + path.read_bytes())
    return digest.hexdigest()[:12]
