"""The campaign's nursery: a process that has everything imported, and forks one child per case.

A case has a process of its own, which a crash may take along and which a limit ends, and costs no
start of Python. A request is a line of JSON on the standard input, the answer to it a line with the
child's exit code. As a library: :class:`Nursery` is the other end of both.
"""

from __future__ import annotations

import contextlib
import faulthandler
import gc
import importlib
import json
import os
import pkgutil
import shutil
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

MEMORY: Final = 8 << 30  # [B] of address space that a child may take
FILE: Final = 1 << 30  # [B] that it may write into one file
RUNS: Final = 12  # of a study that a child makes; then it is interrupted
TIME: Final = 0.3  # [s] that each of these runs simulates at most


@dataclass(frozen=True)
class Ended:
    """How a command ended.

    Attributes:
        code: as :mod:`subprocess` has it; -SIGALRM: at the limit.
        out: its standard output.
        err: its standard error.
    """

    code: int
    out: str
    err: str

    @property
    def hung(self) -> bool:
        """Whether it was ended at its limit."""
        return self.code == -signal.SIGALRM


class Nursery:
    """Types ``giveway`` commands into children of a nursery; if that dies, the campaign ends."""

    def __init__(self, cache: Path) -> None:
        """``cache`` is a folder for what giveway keeps in the user's cache, but the kernels."""
        self._cache = cache
        self._process: subprocess.Popen[str] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.communicate()
            self._process = None

    def type(
        self, words: Sequence[object], cwd: Path, limit: int, cache: Path | None = None
    ) -> Ended:
        """Type a command.

        Args:
            words: after ``giveway``.
            cwd: where it is typed; its outputs are kept beside it, as ``NAME.out``, ``NAME.err``.
            limit: [s] after which it is ended.
            cache: folder of kernels for a process of its own; None: a child of the nursery.
        """
        out, err = (cwd.with_name(f"{cwd.name}.{name}") for name in ("out", "err"))
        typed = [str(word) for word in words]
        if cache is not None:
            return self._alone(typed, cwd, limit, cache)
        request = {"words": typed, "cwd": str(cwd), "limit": limit}
        process = self._process or self._started()
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(request | {"out": str(out), "err": str(err)}) + "\n")
        process.stdin.flush()
        answer = process.stdout.readline()
        if not answer:
            self._process = None
            raise RuntimeError(f"the nursery died of {' '.join(typed)}")
        texts = [path.read_text(encoding="utf-8", errors="replace") for path in (out, err)]
        return Ended(int(answer), *texts)

    def _alone(self, typed: list[str], cwd: Path, limit: int, cache: Path) -> Ended:
        """Type a command into a process that starts with the kernels of ``cache``."""
        done = subprocess.Popen(
            [sys.executable, "-m", "giveway", *typed],
            cwd=cwd,
            env=self.environment | {"NUMBA_CACHE_DIR": str(cache)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
        try:
            out, err = done.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(done.pid, signal.SIGKILL)
            out, err = done.communicate()
            return Ended(-signal.SIGALRM, out, err)
        return Ended(done.returncode, out, err)

    @property
    def environment(self) -> dict[str, str]:
        """The environment of the commands that are typed."""
        from giveway._kernels.cache import kernel_cache

        environment = {
            **os.environ,
            "NUMBA_CACHE_DIR": str(kernel_cache().parent),
            "COLUMNS": "120",
        }
        environment |= {"XDG_CACHE_HOME": str(self._cache), "NO_COLOR": "1", "MPLBACKEND": "agg"}
        return environment | dict.fromkeys(("OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")

    def _started(self) -> subprocess.Popen[str]:
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=self.environment,
        )
        return self._process


# ---- in the nursery ----


def main() -> None:
    """Import, warm up, and fork one child for each line of the standard input."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    _warm_up()
    for line in sys.stdin:
        request = json.loads(line)
        child = os.fork()
        if child == 0:
            _become(request)
        _, status = os.waitpid(child, 0)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # whom it has left behind
        answers.write(f"{os.waitstatus_to_exitcode(status)}\n")
        answers.flush()


def _warm_up() -> None:
    """Do once what each child would do: import, load kernels, ask for the software's identity."""
    import giveway

    for module in pkgutil.walk_packages(giveway.__path__, "giveway."):
        if not module.name.endswith("__main__") and "cluster" not in module.name:
            importlib.import_module(module.name)
    from giveway.precompile import _tiny_run
    from giveway.studies.identity import software_identity

    _tiny_run()
    software_identity()
    gc.freeze()


def _become(request: dict[str, Any]) -> None:
    """Be the command that is asked for, and end with it."""
    import resource  # Windows has none, nor any fork

    code = 1
    journal = Path(f"{request['err']}.journal")
    try:
        os.setpgid(0, 0)
        for number, place in ((0, os.devnull), (1, request["out"]), (2, request["err"])):
            flags = os.O_RDONLY if number == 0 else os.O_WRONLY | os.O_CREAT | os.O_TRUNC
            os.dup2(os.open(place, flags, 0o644), number)
        os.chdir(request["cwd"])
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_FSIZE, (FILE, FILE))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.alarm(request["limit"])
        faulthandler.dump_traceback_later(max(1, request["limit"] - 1), exit=False)
        _spare_processes()
        from giveway.cli import main as giveway
        from giveway.processes.child import JOURNAL_VARIABLE

        words = request["words"]
        sys.argv = ["giveway", *words]
        if words[0] == "rerun":  # as by its supervisor, who would start Python once more
            journal.mkdir()
            os.environ[JOURNAL_VARIABLE] = str(journal)
        try:
            giveway([*words, "--no-isolate"] if words[0] == "run" else words)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException:
            traceback.print_exc()
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError):
                stream.flush()
    finally:
        shutil.rmtree(journal, ignore_errors=True)
        os._exit(code)


def _spare_processes() -> None:
    """What giveway does in further processes, so that a crash costs little, is done in this one.

    A case that dies of that is typed again as a user does, and judged by what is said then.
    """
    from giveway.processes import child
    from giveway.studies.study_options import StudyOptions

    child._supervised = True  # the scenario is not read first by a child
    StudyOptions.executor = lambda _: _Here()  # type: ignore[method-assign,assignment]


class _Here:
    """An executor of a study without processes, which makes a few short runs."""

    workers = 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def run(self, tasks: Iterable[Any]) -> Iterator[Any]:
        from dataclasses import replace

        from giveway.studies.execution.perform import perform

        for count, task in enumerate(tasks):
            if count == RUNS:
                raise KeyboardInterrupt
            config = json.loads(task.config)
            if not isinstance(config["time_limit"], float) or config["time_limit"] > 1.0:
                config["time_limit"] = TIME
            yield perform(replace(task, config=json.dumps(config)))


if __name__ == "__main__":
    main()
