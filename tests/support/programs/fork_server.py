"""Start Python programs without Python's start: a process that has imported SUMO, and forks.

Each program still runs in a process of its own, which a crash may take along and in which nobody
has simulated anything before. A request is a line of JSON on the standard input, the answer to it a
line with the program's exit code.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import runpy
import signal
import sys
import traceback
from typing import Any

PRELOADED = (
    "numpy",
    "libsumo",
    "giveway.scenario_files",
    "giveway.sumo.persons.scenario_persons",
)


def main() -> None:
    for module in PRELOADED:
        importlib.import_module(module)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            become(json.loads(line))
        _, status = os.waitpid(child, 0)
        answers.write(f"{os.waitstatus_to_exitcode(status)}\n")
        answers.flush()


def become(request: dict[str, Any]) -> None:
    """Be the program that is asked for, and end with it."""
    code = 1
    try:
        for number, place in ((0, os.devnull), (1, request["stdout"]), (2, request["stderr"])):
            flags = os.O_RDONLY if number == 0 else os.O_WRONLY | os.O_CREAT
            os.dup2(os.open(place, flags), number)
        os.chdir(request["cwd"])
        os.environ.clear()
        os.environ.update(request["environment"])
        signal.alarm(request["timeout"])
        sys.argv = request["words"]
        try:
            runpy.run_path(sys.argv[0], run_name="__main__")
            code = 0
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException:
            traceback.print_exc()
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError):
                stream.flush()
    finally:
        os._exit(code)


if __name__ == "__main__":
    main()
