"""The interpreter of a child is started as ours was."""

import subprocess
import sys

import pytest

from giveway.processes.supervisor import own_command

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")


def test_we_start_again_as_we_were_started() -> None:
    script = "from giveway.processes.supervisor import own_command; print(own_command())"
    done = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", script, "run", "--seed", "1"],
        capture_output=True,
        text=True,
        check=True,
        timeout=180,
    )
    expected = [sys.executable, "-X", "utf8", "-c", script, "run", "--seed", "1"]
    assert done.stdout.strip() == str(expected)
    assert own_command()[0] == sys.executable
