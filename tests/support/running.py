"""Running the programs of the folder of that name, each in a process of its own.

They lie in a folder of their own: Python looks for packages beside a program first.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SERVER = Path(__file__).parent / "programs" / "fork_server.py"
Done = subprocess.CompletedProcess[str]


@pytest.fixture(scope="session")
def run_program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Done]]:
    """Run a Python program: (path, words..., cwd=..., timeout=[s]).

    libsumo holds one simulation per process, and a crash of SUMO's must be a test that fails.
    """
    if not hasattr(os, "fork"):

        def start(*words: object, cwd: Path, timeout: int = 120) -> Done:
            command = [sys.executable, *map(str, words)]
            return subprocess.run(
                command, capture_output=True, text=True, timeout=timeout, check=False, cwd=cwd
            )

        yield start
        return
    folder = tmp_path_factory.mktemp("programs")
    server = subprocess.Popen(
        [sys.executable, str(SERVER)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert server.stdin is not None
    assert server.stdout is not None
    count = 0

    def fork(*words: object, cwd: Path, timeout: int = 120) -> Done:
        nonlocal count
        count += 1
        out, err = (folder / f"{count}.{name}" for name in ("out", "err"))
        request = {"words": [str(word) for word in words], "cwd": str(cwd), "timeout": timeout}
        request |= {"stdout": str(out), "stderr": str(err), "environment": dict(os.environ)}
        server.stdin.write(json.dumps(request) + "\n")
        server.stdin.flush()
        code = int(server.stdout.readline())
        texts = (path.read_text(encoding="utf-8", errors="replace") for path in (out, err))
        return subprocess.CompletedProcess(request["words"], code, *texts)

    yield fork
    server.stdin.close()
    server.wait(timeout=60)
    server.stdout.close()
