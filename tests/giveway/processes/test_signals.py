"""Signals and terminals: who ends a run decides, and a terminal is left as it was."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from giveway.journal.journal_reader import read_journal

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the deaths here are Unix's")

# A supervisor in a process of its own, for what is done to supervisors.
# Whether it obeys SIGHUP is said to it: what we inherited is nohup's, or a CI runner's.
PARENT = """
import dataclasses, json, signal, sys
from pathlib import Path
from giveway.processes import relay, supervisor

relay._PATIENCE, supervisor._POLL = 0.3, 0.05
script, journal, hang_limit, hangup = sys.argv[1:]
signal.signal(signal.SIGHUP, getattr(signal, hangup))
verdict = supervisor.supervise(
    [sys.executable, script], Path(journal), hang_limit=float(hang_limit)
)
print("VERDICT", json.dumps(dataclasses.asdict(verdict)), flush=True)
"""
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
    script: Path,
    journal: Path,
    hang_limit: float = 30.0,
    *,
    hangup: str = "SIG_DFL",
    **options: Any,
) -> subprocess.Popen[str]:
    words = [str(script), str(journal), str(hang_limit), hangup]
    command = [sys.executable, "-c", PARENT, *words]
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
        output = parent.communicate(timeout=120)[0]
    assert output.startswith("HEEDED 1\n")
    verdict = verdict_in(output)
    assert (verdict["code"], verdict["crashed"], verdict["interrupted"]) == (130, False, True)


def test_a_second_signal_kills_a_child_that_does_not_heed(
    child: Callable[[str], Path], journal: Path
) -> None:
    deaf = "print('READY', flush=True); ctypes.PyDLL(None).sleep(60)"
    body = f"with DeferredInterrupt(): {deaf}".replace("sleep(60)", "sleep(60), time.sleep(60)")
    with start(child(body), journal, stderr=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        assert parent.stderr is not None
        parent.stdout.readline()
        parent.send_signal(signal.SIGTERM)
        parent.send_signal(signal.SIGTERM)  # one that comes before the note does nothing
        note = parent.stderr.readline()
        parent.send_signal(signal.SIGTERM)
        verdict = verdict_in(parent.communicate(timeout=120)[0])
    assert note.startswith("note: SIGTERM has not been heard yet ")
    assert "a second one kills the run" in note
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
from giveway.processes.child import Supervised, take_journal_folder
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
        output, errors = parent.communicate(timeout=120)
    assert output.startswith("HEARD\n")
    assert all(line.startswith("note: SIGINT ") for line in errors.splitlines())
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
        output = parent.communicate(timeout=120)[0]
    assert output.startswith("TIDY\n")
    assert verdict_in(output)["code"] == 130


def test_a_terminal_that_is_closed_costs_no_row(
    child: Callable[[str], Path], journal: Path
) -> None:
    with start(child("print('READY', flush=True); time.sleep(60)"), journal) as parent:
        assert parent.stdout is not None
        parent.stdout.readline()
        parent.send_signal(signal.SIGHUP)
        verdict = verdict_in(parent.communicate(timeout=120)[0])
    assert (verdict["crashed"], verdict["code"], verdict["interrupted"]) == (False, 129, True)
    assert len(read_journal(journal).tables["ego"]) == 3


def test_under_nohup_a_terminal_that_is_closed_ends_nothing(
    child: Callable[[str], Path], journal: Path
) -> None:
    hangs_up = """
        for process in (os.getppid(), os.getpid()):
            os.kill(process, signal.SIGHUP)
        time.sleep(0.2)
        print("WENT ON", flush=True)
    """
    with start(child(hangs_up), journal, hangup="SIG_IGN") as parent:
        output = parent.communicate(timeout=120)[0]
    assert output.startswith("WENT ON\n")
    verdict = verdict_in(output)
    assert (verdict["code"], verdict["crashed"], verdict["interrupted"]) == (0, False, False)


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
        verdict = verdict_in(parent.communicate(timeout=120)[0])
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
