"""Runs with somebody else's FMU: as a user types them, and as the library drives them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import tomllib
from typing import TYPE_CHECKING, Any

import psutil
import pytest
import tomlkit

from fmus.isolation import IsolatedVehicle
from fmus.profile.vehicle_profile import make_profile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


@pytest.fixture
def own_temp(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for temporary files that nobody else uses."""
    folder = tmp_path / "temp"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.fixture
def profiled() -> Callable[..., Path]:
    """Write a car's profile with some of its tables' keys changed, beside the car."""

    def write(car: Path, **tables: dict[str, Any]) -> Path:
        path = car.with_suffix(".toml")
        values = tomllib.loads(path.read_text(encoding="utf-8"))
        for table, keys in tables.items():
            for key, value in keys.items():
                old = values.setdefault(table, {}).get(key)
                values[table][key] = {**old, **value} if isinstance(old, dict) else value
        changed = car.with_suffix(".changed.toml")
        changed.write_text(tomlkit.dumps(values), encoding="utf-8")
        return changed

    return write


@pytest.fixture
def isolated(zoo: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., IsolatedVehicle]]:
    """Open a car of the zoo in a process of its own; all are closed at the end.

    The patience is long, for a busy machine's sake, unless it is what a test is about. The name of
    the present test is kept from the watchdog, which may serve those of the next tests, too.
    """
    vehicles = []

    def open_(
        path: Path,
        profile: dict[str, Any] | None = None,
        *,
        start_timeout: float = 60.0,
        step_timeout: float = 60.0,
    ) -> IsolatedVehicle:
        values = zoo.profile(path) if profile is None else profile
        values["fmu"] |= {"start_timeout": start_timeout, "step_timeout": step_timeout}
        made = make_profile(values, "the test's profile")
        with monkeypatch.context() as there:
            there.delenv("PYTEST_CURRENT_TEST")
            vehicles.append(IsolatedVehicle(path, step_size=0.05, profile=made))
        return vehicles[-1]

    yield open_
    for vehicle in vehicles:
        vehicle.close()


@pytest.fixture
def giveway(
    type_here: Callable[..., subprocess.CompletedProcess[str]], own_temp: Path
) -> Iterator[Callable[..., subprocess.CompletedProcess[str]]]:
    """Type a command in this process; no process and no file of it may be left afterwards."""
    before = set(psutil.Process().children(recursive=True))

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        done = type_here(*words)
        assert set(psutil.Process().children(recursive=True)) <= before
        assert not list(own_temp.iterdir())
        return done

    return run


@pytest.fixture
def giveway_outside(
    tmp_path: Path, own_temp: Path
) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a command line in a process of its own; nothing of it may be left afterwards."""

    def run(*words: object, cleans_up: bool = True) -> subprocess.CompletedProcess[str]:
        process = subprocess.Popen(
            [sys.executable, "-m", "giveway", *map(str, words)],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "TMPDIR": str(own_temp)},
            start_new_session=True,
        )
        try:
            out, err = process.communicate(timeout=180)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            raise
        left = [p for p in psutil.process_iter() if _has_session(p, process.pid)]
        assert not left, left
        assert not cleans_up or not list(own_temp.iterdir())
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    return run


def _has_session(process: psutil.Process, session: int) -> bool:
    try:
        return os.getsid(process.pid) == session
    except ProcessLookupError:
        return False
