"""The memory of a command counts with that of its children."""

import sys
from pathlib import Path

import pytest
from an_hour import build, watched

CHILD = "import time; held = b'x' * 60_000_000; time.sleep(0.5)"
PARENT = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {CHILD!r}])"


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux's /proc")
def test_the_memory_of_children_counts() -> None:
    memory, journal = watched([sys.executable, "-c", PARENT])
    assert 40e6 < memory < 400e6
    assert journal == 0


def test_the_plaza_can_be_built(tmp_path: Path) -> None:
    folder = build(tmp_path / "plaza", fcd=True)
    assert "fcd.xml.gz" in (folder / "plaza.sumocfg").read_text()
    assert 'id="plaza"' in (folder / "plaza.net.xml").read_text()
