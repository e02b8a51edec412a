"""Isolated cars of the zoo; after each test, nothing of them is left."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import locale
import os
import signal
import tempfile
import threading
from pathlib import Path

import pytest

from fmus.isolation import IsolatedVehicle
from fmus.profile.vehicle_profile import make_profile

STEP = 0.05  # [s]


def profile_of(zoo, path, **fmu):
    """The car's profile with other values in its [fmu]."""
    values = zoo.profile(path)
    values["fmu"] = values.get("fmu", {}) | fmu
    return make_profile(values, f"{path.name}'s profile")


@pytest.fixture
def isolated(zoo, nothing_left):
    """Make isolated cars; they are closed after the test, and then nothing of them is left."""
    with contextlib.ExitStack() as stack:

        def make(*, start_timeout=60.0, step_timeout=60.0, **car):
            path = zoo.car(**car)
            profile = profile_of(zoo, path, start_timeout=start_timeout, step_timeout=step_timeout)
            vehicle = IsolatedVehicle(path, step_size=STEP, profile=profile)
            return stack.enter_context(vehicle)

        yield make


def children():
    """The processes that this one has to wait for, zombies too."""
    return set(Path(f"/proc/self/task/{os.getpid()}/children").read_text().split())


def descended(folder):
    """The processes, wherever they went, that work for a vehicle in ``folder``."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if str(folder).encode() in entry.read_bytes():
                found.append(entry.parent.name)
        except OSError:
            continue  # it has just ended
    return found


def host_state():
    """What an FMU could spoil in its process."""
    libm = ctypes.CDLL("libm.so.6")
    mask = os.umask(0)
    os.umask(mask)
    return {
        "working folder": Path.cwd(),
        "locale": locale.setlocale(locale.LC_ALL),
        "rounding": libm.fegetround(),
        "traps": libm.fegetexcept(),
        "signal handlers": {n: signal.getsignal(n) for n in signal.valid_signals()},
        "mask": mask,
        "environment": {k: v for k, v in os.environ.items() if k != "PYTEST_CURRENT_TEST"},
        "files": sorted(file.name for file in Path("/proc/self/fd").iterdir()),
    }


@pytest.fixture(scope="module", autouse=True)
def _older_objects_stay():
    """Garbage is sought among the objects of these tests only: the other ones take long."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True)
def nothing_left(tmp_path, monkeypatch, _older_objects_stay):
    """This process is as before; no process, thread, file or temporary folder is left."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    gc.collect()
    before, offspring, threads = host_state(), children(), threading.enumerate()
    yield temporary
    gc.collect()
    assert children() <= offspring
    assert threading.enumerate() == threads
    assert not list(temporary.iterdir())
    assert not descended(temporary)
    assert host_state() == before
