"""Typing ``giveway`` commands: in this process, which costs nothing, or in one of their own."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

Typed = subprocess.CompletedProcess[str]


@pytest.fixture
def type_here(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> Callable[..., Typed]:
    """Type a command in ``tmp_path``, in this process; ``giveway run`` gets ``--no-isolate``.

    Other commands that are supervised start their child as if they had been typed in a shell.
    What native code and children print is captured, too.
    """
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setenv("NO_COLOR", "1")

    def type_(*words: object, cwd: Path = tmp_path) -> Typed:
        typed = [str(word) for word in words]
        if typed[:1] == ["run"]:
            typed.append("--no-isolate")  # a supervised run is a process of its own
        from giveway.cli import main

        capfd.readouterr()
        with monkeypatch.context() as there:
            there.chdir(cwd)
            command = [sys.executable, "-m", "giveway", *typed]
            there.setattr("giveway.cli.guards.isolated.own_command", lambda: command)
            with pytest.raises(SystemExit) as ended:
                main(typed)
        out, err = capfd.readouterr()
        code = ended.value.code
        assert isinstance(code, int)
        return subprocess.CompletedProcess(["giveway", *typed], code, out, err)

    return type_


@pytest.fixture
def type_outside(tmp_path: Path) -> Callable[..., Typed]:
    """Type a command in ``tmp_path``, in a process of its own, as a user does."""

    def type_(*words: object, cwd: Path = tmp_path) -> Typed:
        return subprocess.run(
            [sys.executable, "-m", "giveway", *map(str, words)],
            cwd=cwd,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )

    return type_
