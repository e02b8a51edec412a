"""A refusal costs next to nothing, whatever the archive claims."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import pytest

MEGABYTE = 1 << 20
OPEN, CLOSE = b"<fmiModelDescription>", b"</fmiModelDescription>"
HUGE = """
import sys
from pathlib import Path
from fmus.archive.archive_check import open_archive
from fmus.errors import FmuFileError
try:
    open_archive(Path(sys.argv[1]))
except FmuFileError as error:
    status = Path("/proc/self/status").read_text()  # ru_maxrss would count the parent, too
    most = int(status.partition("VmHWM:")[2].split()[0])
    sys.exit(0 if most < 200 * 1024 else f"{most} KiB")
sys.exit("not refused")
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("kind", ["bomb", "members", "description", "elements"])
def test_a_refusal_takes_little_memory(archive, kind):
    if kind == "bomb":
        path = archive(("resources/zeros", bytes(96 * MEGABYTE)))
    elif kind == "members":
        path = archive(*((str(n), b"") for n in range(50_000)))
    elif kind == "description":
        path = archive(description=OPEN + b" " * (96 * MEGABYTE) + CLOSE)
    else:
        path = archive(description=OPEN + b'<b c="d"/>' * 600_000 + CLOSE)
    command = [sys.executable, "-c", textwrap.dedent(HUGE), path]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
