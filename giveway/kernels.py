"""The one-time compilation of the numerical kernels, made visible."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway import __version__
from giveway._environment import kernel_cache

if TYPE_CHECKING:
    from rich.console import Console

_MESSAGE = "Compiling the numerical kernels (once after installation, about half a minute) ..."


def compile_kernels_once(console: Console) -> None:
    """Compile and cache every kernel of a run, with a message, unless that has been done.

    A tiny run touches them all; numba keeps the machine code in the user's cache folder.
    """
    import numba

    marker = kernel_cache() / f"compiled-giveway{__version__}-numba{numba.__version__}"
    if marker.exists():
        return
    with console.status(_MESSAGE):
        if not console.is_terminal:
            console.print(_MESSAGE)
        _tiny_run()
    try:
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
    except OSError:
        return  # without a writable cache they are compiled in every process: slow, not wrong


def _tiny_run() -> None:
    from giveway.api import run

    for controller in ("mpc", "pid"):
        crowd = {"pedestrians": 3, "spawn_area": (8.0, -3.0, 12.0, 3.0)}
        result = run({"time_limit": 0.2, "controller": controller, "crowd": crowd})
        result.summary  # noqa: B018 - the metrics have kernels too
