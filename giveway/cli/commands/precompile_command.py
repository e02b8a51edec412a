"""The command ``giveway precompile``: all kernels in a folder, for images and clusters."""

import os
from pathlib import Path

from rich.console import Console

from giveway._cache_folder import CHOICE, objection
from giveway.cli.screen.printing import print_place
from giveway.errors import InstallationError


def precompile_command(into: Path | None = None) -> None:
    """Compile all kernels for this processor and print their folder.

    Args:
        into: Folder for them, or None for the user's cache.

    Raises:
        InstallationError: nothing can be kept safely in the folder.
    """
    if into is not None:
        into = into.absolute()
        why = objection(into, named=True)
        if not why and not os.access(into, os.W_OK):
            why = f"{into} cannot be written"
        if why:
            raise InstallationError(
                f"--into {into}: {why}; expected a folder in which only you can write; "
                "name another, or correct its permissions (chmod go-w)"
            )
        os.environ[CHOICE] = str(into)
    from giveway._kernels.cache import kernel_cache
    from giveway.precompile import compile_kernels_once

    console = Console()
    compile_kernels_once(console, threads=2)
    print_place(console, "Kernels", kernel_cache())
    if into is not None:
        console.print(f"Set {CHOICE}={into} where giveway runs.", soft_wrap=True, highlight=False)
