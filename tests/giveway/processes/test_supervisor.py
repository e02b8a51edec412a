"""Real processes that really die: the verdict names cause and place, and no row is lost."""

import os
import re
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from giveway.journal.journal_reader import read_journal
from giveway.processes.heartbeat import Phase
from giveway.processes.supervisor import Verdict, supervise

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")


@pytest.fixture
def fate(child: Callable[[str], Path], journal: Path) -> Callable[..., Verdict]:
    """What the supervisor says of a child that does ``body``."""

    def run(body: str, hang_limit: float = 30.0) -> Verdict:
        return supervise([sys.executable, str(child(body))], journal, hang_limit=hang_limit)

    return run


@pytest.mark.parametrize(
    ("body", "cause", "code"),
    [
        ("ctypes.string_at(0)", "SIGSEGV", 139),
        ("os.abort()", "SIGABRT", 134),
        ("os.kill(os.getpid(), signal.SIGBUS)", "SIGBUS", 135),
        ("os.kill(os.getpid(), signal.SIGFPE)", "SIGFPE", 136),
        ("os.kill(os.getpid(), signal.SIGKILL)", "SIGKILL (as a rule the system, out of m", 137),
        ("os._exit(0)", "exit(0) called by native code", 1),
        ("ctypes.CDLL(None).exit(0)", "exit(0) called by native code", 1),
        ("ctypes.CDLL(None).exit(3)", "exit(3) called by native code", 3),
    ],
)
def test_a_death_is_told_and_loses_no_row(
    fate: Callable[..., Verdict], journal: Path, body: str, cause: str, code: int
) -> None:
    verdict = fate(body)
    assert verdict.crashed
    assert not verdict.interrupted
    assert verdict.code == code
    assert verdict.message.startswith(cause)
    assert verdict.message.endswith("inside SUMO's step from 12.30 s (step 2)")
    assert read_journal(journal).tables["ego"]["step"].tolist() == [0, 1, 2]


def test_python_says_where_it_stood(fate: Callable[..., Verdict]) -> None:
    verdict = fate("ctypes.string_at(0)")
    assert "Segmentation fault" in verdict.traceback
    assert "in step_sumo" in verdict.traceback


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("pass", 0),
        ("sys.exit(2)", 2),
        ("sys.exit('no such scenario')", 1),
        ("raise ValueError('a fault of ours')", 1),
        ("atexit.register(ctypes.string_at, 0)", 0),  # native libraries die tidying up
        ("atexit.register(ctypes.string_at, 0); sys.exit(2)", 2),
    ],
)
def test_an_end_that_was_said_is_no_crash(
    fate: Callable[..., Verdict], body: str, code: int
) -> None:
    verdict = fate(body)
    assert not verdict.crashed
    assert verdict.code == code
    assert verdict.message == ""
    assert verdict.pulse.phase is Phase.DONE


def test_python_that_cannot_begin_has_said_why_itself(journal: Path) -> None:
    verdict = supervise([sys.executable, "-c", "import not_there"], journal)
    assert not verdict.crashed
    assert verdict.code == 1


def test_a_native_call_that_hangs_with_pythons_lock(fate: Callable[..., Verdict]) -> None:
    verdict = fate("ctypes.PyDLL(None).pause()", hang_limit=0.4)
    assert verdict.message.startswith("no progress for 0.4 s inside SUMO's step from 12.30 s")
    assert "in step_sumo" in verdict.traceback  # it says where before it is killed


def test_a_child_that_cannot_even_speak(fate: Callable[..., Verdict], journal: Path) -> None:
    verdict = fate("os.kill(os.getpid(), signal.SIGSTOP)", hang_limit=0.4)
    assert verdict.cause == "no progress for 0.4 s"
    assert verdict.code == 137
    assert len(read_journal(journal).tables["ego"]) == 3


def test_what_is_set_up_for_ever_hangs(fate: Callable[..., Verdict]) -> None:
    body = "journal.heartbeat.beat(Phase.LOADING); time.sleep(60.0)"
    told = fate(body, hang_limit=0.1).message
    assert re.fullmatch(r"no progress for 0.5\d* s while the run was being set up", told)


def test_slow_is_not_hanging(fate: Callable[..., Verdict]) -> None:
    steps = """
        for k in range(8):
            time.sleep(0.2)
            journal.heartbeat.step(k, 13.0)
        journal.heartbeat.beat(Phase.WRITING)  # and writing takes the time it takes
        time.sleep(1.0)
    """
    assert not fate(steps, hang_limit=0.6).crashed


SUMO_RUN = """
import os
import libsumo
from giveway.processes.heartbeat import Phase
from giveway.journal.journal import Journal
from giveway.processes.child import Supervised, take_journal_folder
from sumo_scenarios import find

folder = take_journal_folder()
with Supervised(folder):
    journal = Journal(folder)
    libsumo.start(["sumo", "-c", str(find("street").config_file), "--no-step-log"])
    journal.write_meta({"pid": os.getpid()})
    rows = journal.rows("step", ("step", "vehicles"))
    k = 0
    while True:
        journal.heartbeat.step(k, libsumo.simulation.getTime())
        rows.block(1)[0] = k, libsumo.vehicle.getIDCount()
        journal.commit()
        journal.heartbeat.beat(Phase.SUMO)
        libsumo.simulationStep()
        k += 1
"""


def test_sumo_killed_in_the_middle_of_a_simulation(tmp_path: Path, journal: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(SUMO_RUN)

    def kill() -> None:
        while read_journal(journal).commits < 100:
            time.sleep(0.02)
        os.kill(read_journal(journal).meta["pid"], signal.SIGSEGV)

    killer = threading.Thread(target=kill)
    killer.start()
    verdict = supervise([sys.executable, str(script)], journal)
    killer.join()
    rows = read_journal(journal).tables["step"]
    assert verdict.cause == "SIGSEGV"
    assert verdict.pulse.phase is Phase.SUMO
    # Every step up to the one it died in, and that one is named.
    assert rows["step"].tolist() == list(range(len(rows)))
    assert len(rows) >= 100
    assert verdict.pulse.step in (len(rows) - 1, len(rows))
    assert verdict.pulse.time == pytest.approx(verdict.pulse.step * 0.1)


# SUMO 1.28 dies of moves that are pending when a simulation is closed, in the next simulation.
SUMO_CRASH = """
import libsumo
from giveway.processes.heartbeat import Phase
from giveway.journal.journal import Journal
from giveway.processes.child import Supervised, take_journal_folder
from sumo_scenarios import find

ids = [f"p{i}" for i in range(50)]
folder = take_journal_folder()
with Supervised(folder):
    journal = Journal(folder)
    rows = journal.rows("round", ("round",))
    for k in range(10):
        rows.block(1)[0] = k
        journal.heartbeat.step(k, 0.0)
        journal.commit()
        journal.heartbeat.beat(Phase.SUMO)
        config = str(find("shared_space").config_file)
        libsumo.start(["sumo", "-c", config, "--no-step-log", "--no-warnings"])
        for name in ids:
            libsumo.person.add(name, "gate", 1.0, -3)
            libsumo.person.appendWalkingStage(name, ["gate"], -1)
        libsumo.simulationStep()
        for name in ids:
            libsumo.person.moveToXY(name, "", 25.0, -13.0, 0.0, 2, -1.0)
        libsumo.close()
"""


def test_a_segmentation_fault_of_sumos_own(tmp_path: Path, journal: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(SUMO_CRASH)
    verdict = supervise([sys.executable, str(script)], journal)
    assert verdict.message.startswith("SIGSEGV inside SUMO's step from 0.00 s")
    assert "libsumo" in verdict.traceback
    rounds = read_journal(journal).tables["round"]["round"].tolist()
    assert rounds == list(range(verdict.pulse.step + 1))
