"""Real processes that really die: the verdict names cause and place, and no row is lost."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from giveway.heartbeat import Phase
from giveway.journal_reader import read_journal
from giveway.supervised import JOURNAL_VARIABLE, take_journal_folder
from giveway.supervisor import Verdict, journal_folder, own_command, supervise

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")

# A run of three committed steps that then does what `body` says, where SUMO would step.
CHILD = """
import atexit, ctypes, os, signal, sys, time
from giveway.heartbeat import Phase
from giveway.interrupts import DeferredInterrupt
from giveway.journal import Journal
from giveway.supervised import Supervised, take_journal_folder

def step_sumo():
{body}

folder = take_journal_folder()
with Supervised(folder) as supervised:
    supervised.listen()
    journal = Journal(folder)
    journal.write_meta({{"pid": os.getpid()}})
    rows = journal.rows("ego", 1)
    for k in range(3):
        journal.heartbeat.step(k, 12.2 + 0.05 * k)
        journal.heartbeat.beat(Phase.CONTROLLING)
        rows.block(1)[0] = k
        journal.commit()
    journal.heartbeat.beat(Phase.SUMO)
    step_sumo()
"""
# A supervisor in a process of its own, for what is done to supervisors.
PARENT = """
import dataclasses, json, sys
from pathlib import Path
from giveway import supervisor

supervisor._PATIENCE = 0.3
script, journal, hang_limit = sys.argv[1:]
verdict = supervisor.supervise(
    [sys.executable, script], Path(journal), hang_limit=float(hang_limit)
)
print("VERDICT", json.dumps(dataclasses.asdict(verdict)), flush=True)
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
    assert read_journal(journal).tables["ego"][:, 0].tolist() == [0, 1, 2]


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
from giveway.heartbeat import Phase
from giveway.journal import Journal
from giveway.supervised import Supervised, take_journal_folder
from sumo_scenarios import find

folder = take_journal_folder()
with Supervised(folder):
    journal = Journal(folder)
    libsumo.start(["sumo", "-c", str(find("street").config_file), "--no-step-log"])
    journal.write_meta({"pid": os.getpid()})
    rows = journal.rows("step", 2)
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
    assert rows[:, 0].tolist() == list(range(len(rows)))
    assert len(rows) >= 100
    assert verdict.pulse.step in (len(rows) - 1, len(rows))
    assert verdict.pulse.time == pytest.approx(verdict.pulse.step * 1.0)


# SUMO 1.28 dies of moves that are pending when a simulation is closed, in the next simulation.
SUMO_CRASH = """
import libsumo
from giveway.heartbeat import Phase
from giveway.journal import Journal
from giveway.supervised import Supervised, take_journal_folder
from sumo_scenarios import find

ids = [f"p{i}" for i in range(50)]
folder = take_journal_folder()
with Supervised(folder):
    journal = Journal(folder)
    rows = journal.rows("round", 1)
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
    rounds = read_journal(journal).tables["round"][:, 0].tolist()
    assert rounds == list(range(verdict.pulse.step + 1))


# --- signals and terminals --------------------------------------------------------------------

HEEDS = """
    interrupts = []
    with DeferredInterrupt() as interrupt:
        note = signal.getsignal(signal.SIGINT)
        count = lambda number, frame: (interrupts.append(number), note(number, frame))
        signal.signal(signal.SIGINT, count), signal.signal(signal.SIGTERM, count)
        print("READY", sys.stdout.isatty(), flush=True)
        while not interrupt.requested:
            time.sleep(0.01)
        time.sleep(0.2)
        print("HEEDED", len(interrupts), flush=True)
    sys.exit(130)
"""


def start(
    script: Path, journal: Path, hang_limit: float = 30.0, **options: Any
) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", PARENT, str(script), str(journal), str(hang_limit)]
    streams: dict[str, Any] = {"stdout": subprocess.PIPE, **options}
    return subprocess.Popen(command, text=True, **streams)


def verdict_in(output: str) -> dict[str, object]:
    (line,) = (line for line in output.splitlines() if line.startswith("VERDICT"))
    return dict(json.loads(line.removeprefix("VERDICT ")))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_sent_to_us_alone_reaches_the_child_once(
    child: Callable[[str], Path], journal: Path, number: int
) -> None:
    with start(child(HEEDS), journal) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == "READY False\n"
        parent.send_signal(number)
        output = parent.communicate(timeout=20)[0]
    assert output.startswith("HEEDED 1\n")
    verdict = verdict_in(output)
    assert (verdict["code"], verdict["crashed"], verdict["interrupted"]) == (130, False, True)


def test_a_second_signal_kills_a_child_that_does_not_heed(
    child: Callable[[str], Path], journal: Path
) -> None:
    deaf = "print('READY', flush=True); ctypes.PyDLL(None).sleep(60)"
    body = f"with DeferredInterrupt(): {deaf}".replace("sleep(60)", "sleep(60), time.sleep(60)")
    with start(child(body), journal) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        for _ in range(2):
            parent.send_signal(signal.SIGTERM)
            time.sleep(0.5)
        verdict = verdict_in(parent.communicate(timeout=20)[0])
    assert verdict["cause"] == "killed by a second interrupt"
    assert (verdict["code"], verdict["crashed"], verdict["interrupted"]) == (143, True, True)
    assert len(read_journal(journal).tables["ego"]) == 3


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_ctrl_c_while_python_starts_is_heard_later(tmp_path: Path, journal: Path) -> None:
    script = tmp_path / "slow_to_start.py"
    script.write_text(
        """
import sys, time
print("STARTING", flush=True)
time.sleep(0.5)
from giveway.supervised import Supervised, take_journal_folder
with Supervised(take_journal_folder()) as supervised:
    try:
        supervised.listen()
        print("DEAF", flush=True)
    except KeyboardInterrupt:
        print("HEARD", flush=True)
        sys.exit(130)
"""
    )
    with start(script, journal, stderr=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == "STARTING\n"
        parent.send_signal(signal.SIGINT)
        output, errors = parent.communicate(timeout=20)
    assert output.startswith("HEARD\n")
    assert errors == ""
    verdict = verdict_in(output)
    assert (verdict["code"], verdict["crashed"], verdict["interrupted"]) == (130, False, True)


def test_ctrl_c_before_the_loop_counts_once(child: Callable[[str], Path], journal: Path) -> None:
    # The terminal tells the child, and so do we: the second must not disturb its tidying up.
    body = """
        try:
            print("READY", flush=True)
            time.sleep(20)
        except KeyboardInterrupt:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.1)
            print("TIDY", flush=True)
            sys.exit(130)
    """
    with start(child(body), journal) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        parent.send_signal(signal.SIGINT)
        output = parent.communicate(timeout=20)[0]
    assert output.startswith("TIDY\n")
    assert verdict_in(output)["code"] == 130


def test_a_terminal_that_is_closed_costs_no_row(
    child: Callable[[str], Path], journal: Path
) -> None:
    with start(child("print('READY', flush=True); time.sleep(60)"), journal) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        parent.send_signal(signal.SIGHUP)
        verdict = verdict_in(parent.communicate(timeout=20)[0])
    assert (verdict["cause"], verdict["code"], verdict["interrupted"]) == ("SIGHUP", 129, True)
    assert len(read_journal(journal).tables["ego"]) == 3


def test_a_suspended_run_is_not_a_hanging_one(child: Callable[[str], Path], journal: Path) -> None:
    steps = """
        print("READY", flush=True)
        for k in range(20):
            time.sleep(0.1)
            journal.heartbeat.step(k, 13.0)
    """
    with start(child(steps), journal, 0.9, start_new_session=True) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        os.killpg(parent.pid, signal.SIGSTOP)  # as Ctrl-Z does
        time.sleep(1.2)
        os.killpg(parent.pid, signal.SIGCONT)
        verdict = verdict_in(parent.communicate(timeout=20)[0])
    assert not verdict["crashed"]


@pytest.mark.parametrize("body", ["time.sleep(60)", "ctypes.PyDLL(None).sleep(60)"])
def test_a_child_does_not_outlive_its_supervisor(
    child: Callable[[str], Path], journal: Path, body: str
) -> None:
    with start(child(f"print('READY', flush=True); {body}"), journal) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        parent.kill()
        # The pipe ends when the last process that holds it has ended: nobody is left.
        assert parent.stdout.read() == ""
    assert len(read_journal(journal).tables["ego"]) == 3


def on_a_terminal(script: Path, journal: Path, keys: bytes) -> str:
    """What a terminal shows of a supervised child; ``keys`` are typed when it is READY."""
    import fcntl
    import pty
    import termios

    ours, theirs = pty.openpty()
    terminal = start(
        script,
        journal,
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
    )
    os.close(theirs)
    limit = threading.Timer(30.0, terminal.kill)
    limit.start()
    shown = b""
    try:
        while b"VERDICT" not in shown or not shown.endswith(b"\n"):
            shown += os.read(ours, 4096)
            if keys and b"\n" in shown.partition(b"READY")[2]:
                os.write(ours, keys)
                keys = b""
    finally:
        limit.cancel()
        terminal.kill()
        terminal.wait()
        os.close(ours)
    return shown.decode()


def test_on_a_terminal_all_is_as_without_us(child: Callable[[str], Path], journal: Path) -> None:
    shown = on_a_terminal(child(HEEDS), journal, keys=b"\x03")
    assert "READY True" in shown  # the child has the terminal: colours, progress bar
    assert "HEEDED" in shown
    assert "Traceback" not in shown
    assert verdict_in(shown)["code"] == 130


def test_a_crash_gives_the_terminal_its_cursor_back(
    child: Callable[[str], Path], journal: Path
) -> None:
    shown = on_a_terminal(child("ctypes.string_at(0)"), journal, keys=b"")
    assert "\x1b[?25h" in shown
    assert '"SIGSEGV"' in shown


# --- small things -----------------------------------------------------------------------------


def test_only_the_supervised_process_takes_the_journal(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert take_journal_folder() is None
    monkeypatch.setenv(JOURNAL_VARIABLE, str(tmp_path))
    assert take_journal_folder() == tmp_path
    assert take_journal_folder() is None  # nor do the processes that it starts
    monkeypatch.setenv(JOURNAL_VARIABLE, str(tmp_path / "of a run long gone"))
    assert take_journal_folder() is None


def test_the_folder_of_a_journal_is_gone_afterwards(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    with journal_folder() as folder:
        assert folder.is_dir()
    assert not folder.exists()
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    with journal_folder() as folder:
        assert folder.parent == tmp_path


def test_journals_of_killed_supervisors_do_not_pile_up(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    for name, age in (("giveway-journal-old", 2 * 86400), ("giveway-journal-new", 60)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "rows").touch()
        os.utime(tmp_path / name / "rows", (time.time() - age,) * 2)
    with journal_folder():
        assert not (tmp_path / "giveway-journal-old").exists()
        assert (tmp_path / "giveway-journal-new").exists()


def test_open_files_reach_the_child(tmp_path: Path, journal: Path) -> None:
    """``giveway run --config <(...)`` names a file that only we have open."""
    file = tmp_path / "study.toml"
    file.write_text("seed = 7")
    with file.open() as opened:
        os.set_inheritable(opened.fileno(), True)
        code = f"import os, sys; sys.exit(5 if os.read({opened.fileno()}, 9) == b'seed = 7' else 6)"
        assert supervise([sys.executable, "-c", code], journal).code == 5


def test_we_start_again_as_we_were_started() -> None:
    script = "from giveway.supervisor import own_command; print(own_command())"
    done = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", script, "run", "--seed", "1"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    expected = [sys.executable, "-X", "utf8", "-c", script, "run", "--seed", "1"]
    assert done.stdout.strip() == str(expected)
    assert own_command()[0] == sys.executable


def test_supervising_imports_nothing_heavy() -> None:
    code = "import sys, giveway.supervisor; print({m.split('.')[0] for m in sys.modules})"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    for heavy in ("numpy", "numba", "pandas", "typer", "pydantic", "libsumo", "ctypes"):
        assert f"'{heavy}'" not in done.stdout
