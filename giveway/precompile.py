"""The one-time compilation of the numerical kernels, with a message for the user."""

from __future__ import annotations

import contextlib
import shutil
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from llvmlite.binding import get_host_cpu_name

from controller import LongitudinalModel, Mpc, MpcParameters
from giveway._kernel_cache import FOLDERS, kernel_cache
from pedestrian_model import Crowd

if TYPE_CHECKING:
    from rich.console import Console

_MARKER = "compiled-for-"
_KEPT = 30 * 86400.0  # [s] since the last run
_MESSAGE = "Compiling the numerical kernels (once after installation, about half a minute) ..."


def compile_kernels_once(console: Console | None = None) -> None:
    """Compile and cache every kernel of a run, with a message, unless that has been done.

    A few tiny runs call them all; numba keeps the machine code in the user's cache folder.

    Args:
        console: for the message; None prints nothing.
    """
    marker = kernel_cache() / f"{_MARKER}{get_host_cpu_name()}"
    if marker.exists():
        with contextlib.suppress(OSError):
            marker.touch()  # still in use
        return
    with contextlib.nullcontext() if console is None else console.status(_MESSAGE):
        if console is not None and not console.is_terminal:
            console.print(_MESSAGE)
        _tiny_run()
    try:
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
        forget_old_kernels(marker.parent)
    except OSError:
        return  # without a writable cache they are compiled in every process: slow, not wrong


def forget_old_kernels(folder: Path) -> None:
    """Remove the kernels of versions that have not been run for a month.

    Args:
        folder: of the present kernels; those of other versions are in the folders beside it.
    """
    for other in folder.parent.glob(FOLDERS):
        used = [file.stat().st_mtime for file in (other, *other.glob(f"{_MARKER}*"))]
        if other != folder and time.time() - max(used) > _KEPT:
            shutil.rmtree(other, ignore_errors=True)


def _tiny_run() -> None:
    """Call every kernel once: a free drive, people on the path, background vehicles, walls."""
    from giveway.api import run
    from giveway.records.progress import Ending

    people = {"pedestrians": 3, "spawn_area": (8.0, -3.0, 12.0, 3.0)}
    hard = {"soft": False, "gap_choice": False}  # then nothing is planned, and the PID brakes
    for settings in (
        {"time_limit": 0.2, "crowd": {"pedestrians": 0}},
        {"time_limit": 0.2, "crowd": people, "twin": True},
        {"time_limit": 0.2, "crowd": people, "planner": hard},
        {"time_limit": 0.2, "crowd": {"pedestrians": 0}, "controller": "mpc-paper"},
        {"time_limit": 0.2, "crowd": people, "controller": "mpc-paper"},
        {"time_limit": 1.2, "scenario": "street", "controller": "pid-paper"},
        {"time_limit": 0.3, "scenario": "junction", "crowd": {"walls": True}},
    ):
        result = run(settings)
        if result.ending is Ending.INTERRUPTED:
            raise KeyboardInterrupt
        result.summary  # noqa: B018 - the metrics have kernels too
    _solve_without_solution()
    _come_and_go()


def _solve_without_solution() -> None:
    """A problem without a solution, which takes a certificate: 0.21 m to stop from 1 m/s."""
    mpc = Mpc(LongitudinalModel(), MpcParameters())
    ahead = np.full(mpc.parameters.horizon, mpc.parameters.safe_distance + 0.21)
    mpc.solve(0.0, 1.0, 0.0, ahead)


def _come_and_go() -> None:
    """Pedestrians join a crowd and leave it."""
    one = Crowd.create([(0.0, 0.0)], [(1.0, 0.0)], 1.4, [[(9.0, 0.0)]])
    one.concatenate(one).select(np.array([True, False]))
