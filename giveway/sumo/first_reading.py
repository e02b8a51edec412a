"""The first reading of a scenario, in a child process.

A few broken networks and demands crash the process that reads them. In a supervised run or a worker
of a study that costs one run; in the user's own process, which has called :func:`giveway.run`, it
would cost everything. Therefore a child process tries the same command first, once for each content
of the scenario's files. What SUMO refuses with a message is left to the second reading, which
reports it better. The child runs :func:`main`.
"""

import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from giveway._cache_folder import cache_folder, forget_oldest
from giveway.errors import SumoError
from giveway.processes import interpreter
from giveway.processes.causes import cause_of_end
from giveway.processes.child import is_supervised
from giveway.sumo.library import import_bare_libsumo, version

# Longest time [s] to load a scenario; the largest city scenarios take some minutes
PATIENCE: Final = 600.0
_CHILD: Final = "from giveway.sumo.first_reading import main; main(arguments)"
_ROUTE_STEPS: Final = "--route-steps"  # with 0, SUMO reads all routes at once, not as they depart
_ADDRESS: Final = re.compile(r"[^/\\\s]{2,}:\d+")
_DONE: Final = "read"
_known: set[str] = set()


def read_first(
    config_file: Path,
    command: Sequence[str],
    files: Sequence[Path],
    *,
    patience: float = PATIENCE,
) -> None:
    """Let SUMO read a scenario in a child process, unless that has been done before.

    Args:
        config_file: File .sumocfg, for messages.
        command: Command as for ``libsumo.start``.
        files: Files that SUMO will read.
        patience: Time limit [s].

    Raises:
        SumoError: SUMO crashed, or was still busy.
    """
    if is_supervised() or any(map(_ADDRESS.fullmatch, command)):
        return  # a listener at an output address would take the child for the run
    digest = digest_of(config_file, files)
    marker = cache_folder() / "read_by_sumo" / digest
    if digest in _known or marker.exists():
        return
    at_once = [] if _ROUTE_STEPS in command else [_ROUTE_STEPS, "0"]
    _try(config_file, [*command, *at_once], patience)
    _known.add(digest)
    # without this cache each process reads first, which is slow but not wrong
    with suppress(OSError):
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
        forget_oldest(marker.parent)


def _try(config_file: Path, command: Sequence[str], patience: float) -> None:
    remedy = f"look at it alone: sumo -c {config_file}; netconvert may rebuild the network"
    try:
        result = subprocess.run(
            interpreter.command(_CHILD, command),
            capture_output=True,
            check=False,
            timeout=patience,
            stdin=subprocess.DEVNULL,
        )
    except subprocess.TimeoutExpired:
        raise SumoError(
            f"{config_file}: SUMO was still reading this scenario after {patience:g} s; {remedy}"
        ) from None
    except OSError:
        return  # no process can be started: the second reading becomes the first
    if _DONE.encode() not in result.stdout.split():
        raise SumoError(
            f"{config_file}: SUMO crashes while reading this scenario "
            f"({cause_of_end(result.returncode)}); {remedy}"
        )


def digest_of(config_file: Path, files: Sequence[Path]) -> str:
    """Return a digest of the files' contents and of SUMO's version."""
    digest = hashlib.sha256(version().encode())
    for file in dict.fromkeys((config_file, *files)):
        with suppress(OSError), file.open("rb") as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    return digest.hexdigest()


def main(command: Sequence[str]) -> None:
    """Read the scenario, do one step, and report the end; a refusal is no crash, either."""
    sumo = import_bare_libsumo()
    with suppress(Exception):  # libsumo's exceptions
        sumo.start(list(command))
        sumo.simulationStep()
        sumo.close()
    sys.stdout.write(f"\n{_DONE}\n")
    sys.stdout.flush()
    os._exit(0)  # skips the destructors of native code
