"""Signals from giveway's first line on, while the program is being imported."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")

SENDS = """
import os, signal, sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            sys.meta_path.remove(self)
            {what}

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Finder())
"""
KILL = "os.kill(os.getpid(), signal.{name})"


def giveway(tmp_path, module, what, *words):
    """The end of ``giveway WORDS``, which does ``what`` when it imports a module."""
    (tmp_path / "sitecustomize.py").write_text(SENDS.format(module=module, what=what))
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    command = [sys.executable, *words]
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, check=False, cwd=tmp_path
    )


@pytest.mark.parametrize(
    ("name", "code", "line"),
    [("SIGINT", 130, "interrupted"), ("SIGTERM", 143, "ended by SIGTERM")],
)
@pytest.mark.parametrize("module", ["giveway._start.environment", "giveway.cli.program"])
def test_one_line_and_the_code_of_the_signal(tmp_path, module, name, code, line):
    done = giveway(tmp_path, module, KILL.format(name=name), "-m", "giveway", "scenarios")
    assert (done.returncode, done.stderr, done.stdout) == (code, f"error: {line}\n", "")


def test_a_program_of_somebody_else_ends_as_it_would(tmp_path):
    what = KILL.format(name="SIGTERM")
    done = giveway(tmp_path, "giveway._start.environment", what, "-c", "import giveway")
    assert (done.returncode, done.stderr) == (-15, "")


def test_a_library_that_makes_an_import_error_of_ctrl_c_does_not_hide_it(tmp_path):
    what = f"""
            try:
                {KILL.format(name="SIGINT")}
                for _ in range(100): pass
            except BaseException:
                raise ImportError("cannot load module more than once per process")
"""
    done = giveway(tmp_path, "giveway.cli.app", what, "-m", "giveway", "scenarios")
    assert (done.returncode, done.stderr) == (130, "error: interrupted\n")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_in_the_last_instant_of_a_command_the_work_is_done(tmp_path, name):
    what = f"import atexit; atexit.register(lambda: {KILL.format(name=name)})"
    done = giveway(tmp_path, "giveway.cli.app", what, "-m", "giveway", "scenarios")
    assert (done.returncode, done.stderr) == (0, "")
    assert "shared_space" in done.stdout
