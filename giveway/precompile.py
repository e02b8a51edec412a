"""The one-time compilation of the numerical kernels, with a message for the user."""

import contextlib
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
from rich.console import Console

from controller import LongitudinalModel, Mpc, MpcParameters
from controller.kernels import branch_off
from giveway._kernels.cache import FOLDERS, MARKERS, kernel_cache, marker
from giveway.processes.child import die_with
from giveway.processes.garbage import rarely_collected
from giveway.processes.interpreter import command
from giveway.processes.interrupts import DeferredInterrupt, ended_by
from giveway.processes.processors import processors
from pedestrian_model import Crowd, CrowdModel, Surroundings, Vehicles, arrived
from pedestrian_model.vci.model import THREADS_FROM

_KEPT = 30 * 86400.0  # [s] time since the last run after which old kernels are removed
_MESSAGE = "Compiling the numerical kernels (once after installation, about a minute) ..."
_MESSAGE_THREADS = "Compiling the kernels of several threads (once, some ten seconds) ..."
_LONGEST: Final = 600.0  # Longest wait [s] for the other process
_HELP: Final = "from giveway.precompile import help_compiling; help_compiling(*arguments)"

_PEOPLE: Final = {"pedestrians": 3, "spawn_area": (8.0, -3.0, 12.0, 3.0)}
_FREE: Final[dict[str, Any]] = {"time_limit": 0.2, "crowd": {"pedestrians": 0}}
_PLANNING: Final[dict[str, Any]] = {"time_limit": 0.2, "crowd": _PEOPLE, "twin": True}
_STREET: Final[dict[str, Any]] = {
    "time_limit": 1.2,
    "scenario": "street",
    "controller": "pid-paper",
    "sumo": {"step_length": 1.0},  # between SUMO's steps, kernels move its cars
}
# In this order two processes rarely compile the same: one compiles the crowd, and the search that
# predicts it; the other compiles the vehicle, its plans, metrics and the other controllers.
_WALKS: Final[tuple[dict[str, Any], ...]] = (
    {"time_limit": 0.2, "crowd": _PEOPLE, "ego": {"none": True}},
    {"time_limit": 0.2, "crowd": _PEOPLE, "controller": "mpc-paper"},
    _PLANNING,
)
_OTHERS: Final[tuple[dict[str, Any], ...]] = (
    _FREE | {"metrics": {"impacts": True}},
    _STREET,
    {
        "time_limit": 0.3,
        "scenario": "junction",
        "controller": "pid-paper",
        "crowd": {"walls": True},
    },
    {"time_limit": 0.2, "crowd": _PEOPLE, "controller": "pid-paper", "twin": True},
    {"time_limit": 0.2, "crowd": {"pedestrians": 0}, "controller": "mpc-paper"},
)


def compile_kernels_once(console: Console | None = None, *, threads: int = 1) -> None:
    """Compile and cache every kernel of a run, with a message, unless that has been done.

    A few tiny runs call all kernels; numba keeps the machine code in the user's cache folder.

    Args:
        console: Console for the message, or None to print nothing.
        threads: Number of threads that step the crowd; several threads need further kernels.
    """
    _once(marker(), _MESSAGE, _compile_all, console)
    if threads > 1:
        _once(f"threads-{marker()}", _MESSAGE_THREADS, _step_on_threads, console)


def _once(
    name: str, message: str, compile_them: Callable[[], None], console: Console | None
) -> None:
    """Compile unless a file ``name`` says that it has been done; leave this file."""
    mark = kernel_cache() / name
    if mark.exists():
        with contextlib.suppress(OSError):
            mark.touch()  # the kernels are still in use
        return
    with contextlib.nullcontext() if console is None else console.status(message):
        if console is not None and not console.is_terminal:
            console.print(message)
        with rarely_collected():
            compile_them()
    with contextlib.suppress(OSError):
        mark.touch()
        forget_old_kernels(mark.parent)


def forget_old_kernels(folder: Path) -> None:
    """Remove the kernels of versions that have not been run for a month.

    Args:
        folder: Folder of the present kernels, beside those of other versions.
    """
    for other in folder.parent.glob(FOLDERS):
        used = [file.stat().st_mtime for file in (other, *other.glob(f"{MARKERS}*"))]
        if other != folder and time.time() - max(used) > _KEPT:
            shutil.rmtree(other, ignore_errors=True)


def _compile_all() -> None:
    """Compile in this process and in a second one beside it, then call all kernels.

    The second process steps people and drives through them with the planning controller, which is
    the longest of the runs. Both put compiled code into the cache; the last runs compile the rest.
    """
    with _helper() as helper:
        if helper is not None:
            for settings in _OTHERS:
                _run(settings)
            _call_the_rest()
            with contextlib.suppress(subprocess.TimeoutExpired):
                helper.wait(_LONGEST)
    _tiny_run()


@contextlib.contextmanager
def _helper() -> Iterator[subprocess.Popen[bytes] | None]:
    """Start a process that compiles beside this one, or None if no processor is left for it."""
    try:
        helper = _started() if processors() > 1 else None
    except OSError:
        helper = None  # this process does all the work
    try:
        yield helper
    finally:
        if helper is not None:
            helper.kill()
            helper.wait()


def _started() -> subprocess.Popen[bytes]:
    nothing = subprocess.DEVNULL
    arguments: list[int | str] = [os.getpid()]
    return subprocess.Popen(
        command(_HELP, arguments), stdin=nothing, stdout=nothing, stderr=nothing
    )


def help_compiling(parent: int) -> None:
    """Compile in the process beside ``parent``."""
    die_with(parent)
    with rarely_collected():
        for settings in _WALKS:
            _run(settings, measured=False)


def _tiny_run() -> None:
    """Call every kernel once: a free drive, people on the path, background vehicles, walls."""
    for settings in (
        _FREE,
        _PLANNING,
        {"time_limit": 0.2, "crowd": {"pedestrians": 0}, "controller": "mpc-paper"},
        {"time_limit": 0.2, "crowd": _PEOPLE, "controller": "mpc-paper"},
        _STREET,
        {"time_limit": 0.3, "scenario": "junction", "crowd": {"walls": True}},
    ):
        _run(settings)
    _call_the_rest()


def _call_the_rest() -> None:
    """Call the kernels that no tiny run calls."""
    _solve_without_solution()
    _branch_off()
    _come_and_go()


def _run(settings: dict[str, Any], *, measured: bool = True) -> None:
    from giveway.api import run
    from giveway.run_data.progress import Ending

    result = run(settings)
    if result.ending is Ending.INTERRUPTED:
        raise ended_by(DeferredInterrupt.latest)
    if measured:
        result.summary  # the metrics have kernels, too  # noqa: B018


def _step_on_threads() -> None:
    """Let two threads step a crowd that is large enough for them."""
    n = THREADS_FROM
    places = np.column_stack([np.arange(n) % 40, np.arange(n) // 40]) * 1.5
    ways = np.column_stack([places, places + 9.0]).reshape(n, 2, 2)[:, 1:]
    crowd = Crowd.create(places, np.tile([1.0, 0.0], (n, 1)), 1.4, list(ways))
    CrowdModel(threads=2).advance(crowd, Vehicles.empty(), Surroundings())


def _solve_without_solution() -> None:
    """Solve a problem without a solution, which needs a certificate: 0.21 m to stop from 1 m/s."""
    mpc = Mpc(LongitudinalModel(), MpcParameters())
    ahead = np.full(mpc.parameters.horizon, mpc.parameters.safe_distance + 0.21)
    mpc.solve(0.0, 1.0, 0.0, ahead)


def _branch_off() -> None:
    """Let a manoeuvre brake later, as if it were uncertain whether a person yields."""
    distance, speed, acceleration = np.zeros((3, 4))
    branch_off((distance, speed, acceleration), 1, -1.0, 4.0, 0.05)


def _come_and_go() -> None:
    """Let pedestrians join a crowd and leave it."""
    one = Crowd.create([(0.0, 0.0)], [(1.0, 0.0)], 1.4, [[(9.0, 0.0)]])
    two = one.concatenate(one)
    two.select(~arrived(two, 0.5))
