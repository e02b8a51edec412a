"""The cause of a process's end, in words."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from giveway.processes.causes import cause_of_end, let_speak, stood_still, text_in

HANG = "import faulthandler, time; faulthandler.enable(); print(flush=True); time.sleep(60)"
unix = pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")


@unix
@pytest.mark.parametrize(
    ("code", "cause"),
    [
        (-signal.SIGSEGV, "SIGSEGV"),
        (-signal.SIGKILL, "SIGKILL (as a rule the system, out of memory)"),
        (-60, "signal 60"),
        (3, "exit(3) called by native code"),
        (0xC0000005, "access violation"),
    ],
)
def test_codes_and_signals_have_names(code: int, cause: str) -> None:
    assert cause_of_end(code) == cause


@unix
def test_a_hanging_process_says_where_it_stands() -> None:
    command = [sys.executable, "-c", HANG]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        let_speak(process)
        assert process.returncode == -signal.SIGABRT
        assert b"line 1 in <module>" in process.stderr.read()


def test_a_file_that_is_not_there_has_no_text(tmp_path: Path) -> None:
    (tmp_path / "said").write_bytes(b"  last words\xff\n")
    assert text_in(tmp_path / "said") == "last words\N{REPLACEMENT CHARACTER}"
    assert text_in(tmp_path / "nothing") == ""
    assert stood_still(30.0) == "no progress for 30 s"
