"""The workers' temporary folder goes with the process, even if nobody got hold of it."""

import subprocess
import sys

PROGRAM = """
import sys
from pathlib import Path
from giveway.studies.execution.temporary_folder import Scratch
scratch = Scratch(Path(sys.argv[1]))
scratch.folder().mkdir()
raise KeyboardInterrupt
"""


def test_a_signal_right_after_it_was_made_leaves_nothing(tmp_path):
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(tmp_path)], capture_output=True, check=False
    )
    assert b"KeyboardInterrupt" in ended.stderr
    assert list(tmp_path.iterdir()) == []
