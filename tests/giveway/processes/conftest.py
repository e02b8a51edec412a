"""A supervised child that does what a test wants, and its journal."""

import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

# A run of three committed steps that then does what `body` says, where SUMO would step.
CHILD = """
import atexit, ctypes, os, signal, sys, time
from giveway.processes.heartbeat import Phase
from giveway.processes.interrupts import DeferredInterrupt
from giveway.journal.journal import Journal
from giveway.processes.child import Supervised, take_journal_folder

def step_sumo():
{body}

folder = take_journal_folder()
with Supervised(folder) as supervised:
    supervised.listen()
    journal = Journal(folder)
    journal.write_meta({{"pid": os.getpid()}})
    rows = journal.rows("ego", ("step",))
    for k in range(3):
        journal.heartbeat.step(k, 12.2 + 0.05 * k)
        journal.heartbeat.beat(Phase.CONTROLLING)
        rows.block(1)[0] = k
        journal.commit()
    journal.heartbeat.beat(Phase.SUMO)
    step_sumo()
"""


@pytest.fixture
def child(tmp_path: Path) -> Callable[[str], Path]:
    def write(body: str) -> Path:
        script = tmp_path / "child.py"
        script.write_text(CHILD.format(body=textwrap.indent(textwrap.dedent(body), "    ")))
        return script

    return write


@pytest.fixture
def journal(tmp_path: Path) -> Path:
    folder = tmp_path / "journal"
    folder.mkdir()
    return folder
