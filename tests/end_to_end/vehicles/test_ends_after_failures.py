"""What happens after a run has failed does not make it a success."""

from __future__ import annotations

import subprocess
import sys

import pytest

# The supervisor starts its child with its own command line: both come by here.
COMMAND = """
import atexit, os, signal, sys
if "GIVEWAY_JOURNAL" in os.environ:
    atexit.register(os.kill, os.getpid(), signal.SIGKILL)
from giveway.cli import main
main(sys.argv[1:])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="the death here is Unix's")
def test_a_run_that_fails_and_then_dies_has_failed(tmp_path):
    (tmp_path / "car.fmu").write_text("no archive")
    words = ["run", "shared_space", "--vehicle", "car.fmu", "--out", "results"]
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert "not a zip archive" in done.stderr
    assert done.returncode == 2
