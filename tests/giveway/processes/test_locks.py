"""The lock of a folder."""

import subprocess
import sys
from pathlib import Path

import pytest

from giveway.processes.locks import FolderInUseError, in_use, locked

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows locks nothing")
HOLD = """
import sys
from pathlib import Path
from giveway.processes.locks import locked
with locked(Path(sys.argv[1])):
    print("locked", flush=True)
    sys.stdin.read()
"""


def test_a_folder_is_locked_once_and_free_afterwards(tmp_path: Path) -> None:
    assert not in_use(tmp_path)
    with locked(tmp_path):
        assert in_use(tmp_path)
        with pytest.raises(FolderInUseError), locked(tmp_path):
            pass
    assert not in_use(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_lock_of_a_process_ends_with_it(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"locked\n"
        assert in_use(tmp_path)
        other.kill()
        other.wait()
    assert not in_use(tmp_path)


def test_a_folder_that_is_not_there_cannot_be_locked(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="nowhere"):
        in_use(tmp_path / "nowhere")
