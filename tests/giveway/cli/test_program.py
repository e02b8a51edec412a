"""However a command ends, it ends with one line that says what to do."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys

import pytest

from giveway.processes.interrupts import TerminatedError

COMMAND = "giveway.cli.commands.doctor_command.doctor_command"
INTERRUPTED_WHILE_IMPORTING = """
import os, signal, sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "typer":
            os.kill(os.getpid(), signal.{signal})

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Finder())
from giveway.cli import main
main(["studies"])
"""


@pytest.mark.parametrize(
    ("raised", "code", "line"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (TerminatedError(signal.SIGTERM), 143, "ended by SIGTERM"),
        (
            PermissionError(errno.EACCES, os.strerror(errno.EACCES), "/srv/x"),
            1,
            "/srv/x: Permission denied",
        ),
        (OSError(errno.EIO, os.strerror(errno.EIO)), 1, "output: Input/output error"),
        (
            RuntimeError("can't start new thread"),
            1,
            "the system gives no more threads; end other processes, or raise the limit (ulimit -u)",
        ),
        (MemoryError(), 1, "out of memory; free memory, or raise the limit (ulimit -v)"),
    ],
)
def test_what_ends_a_command_is_one_line(type_here, monkeypatch, raised, code, line):
    def end(*_, **__):
        raise raised

    monkeypatch.setattr(COMMAND, end)
    done = type_here("doctor")
    assert (done.returncode, done.stderr) == (code, f"error: {line}\n")


WHILE_PYTHON_TRIES_A_FOLDER = """
import os, signal, sys
from giveway.cli import main

opened = os.open

def interrupted(path, *rest, **options):
    made = opened(path, *rest, **options)
    if os.path.dirname(os.fsdecode(path)) == os.environ["TMPDIR"]:
        os.kill(os.getpid(), signal.SIGTERM)
    return made

os.open = interrupted
sys.argv = ["giveway", "scenarios"]
main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_a_signal_while_python_tries_the_temporary_folder_leaves_no_file(tmp_path):
    program = [sys.executable, "-c", WHILE_PYTHON_TRIES_A_FOLDER]
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    done = subprocess.run(program, capture_output=True, text=True, check=False, env=environment)
    assert (done.returncode, done.stderr) == (143, "error: ended by SIGTERM\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize(
    ("number", "code", "line"),
    [("SIGINT", 130, "interrupted"), ("SIGTERM", 143, "ended by SIGTERM")],
)
def test_a_signal_in_the_first_instant_is_no_traceback(tmp_path, number, code, line):
    program = INTERRUPTED_WHILE_IMPORTING.format(signal=number)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert (done.returncode, done.stderr) == (code, f"error: {line}\n")


def test_a_folder_may_be_called_like_markup(type_here, tmp_path):
    done = type_here("run", "--pedestrians", 0, "--no-pictures", "--out", "[/home]")
    assert (done.returncode, done.stderr) == (0, "")
    assert "Results in [/home]" in done.stdout
    assert (tmp_path / "[" / "home]" / "ego.csv").is_file()


def test_a_folder_whose_name_is_too_long_is_named(type_here):
    done = type_here("run", "--out", "a" * 300)
    assert done.returncode == 2
    assert done.stderr.startswith("error: aaa")
    assert "cannot be written (File name too long); name another folder with --out" in done.stderr


def test_a_users_file_cannot_steer_the_terminal_or_hide_a_line(type_here, tmp_path):
    (tmp_path / "long.toml").write_text(f'[ego]\nlane = "{"x" * 5000}"\n')
    done = type_here("config", "--config", "long.toml")
    assert done.returncode == 2
    assert "long.toml: [ego] lane" in done.stderr
    assert "more characters)" in done.stderr
    assert len(done.stderr) < 1000
    folder = tmp_path / "turned\u202ered\x1b[31m"
    done = type_here("doctor", folder)
    assert "\u202e" not in done.stdout
    done = type_here("run", folder)
    assert done.returncode == 2
    assert done.stderr.strip().isprintable()
