"""The first check of a Dask scheduler's address, in a process of its own.

The address may belong to anything: a server that accepts and never answers, a web server, a port
that speaks TLS. Dask may then wait for ever, ask for huge amounts of memory, or print messages
while its objects are deleted. In a process of its own this does no harm, and the reason is reported
in a few words.
"""

import os
import subprocess
import threading
from typing import Any, Final, NoReturn

from giveway.processes import interpreter

_START: Final = 60.0  # Time [s] for Python and Dask to start, on a busy machine
_CHILD: Final = "from giveway.studies.execution.cluster_probe import main; main(*arguments)"
# Share of the time limit given to Dask's own timeout, so that its message comes before ours
_OF_IT: Final = 0.8
_ANSWER: Final = "answer: "
_LONGEST: Final = 200  # Largest number of characters of a reason


def reason_against(address: str, limit: float) -> str:
    """Return the reason why no usable Dask scheduler is at an address.

    The text is empty if there is one.

    Args:
        address: Address as Dask writes it.
        limit: Time [s] within which the address has to answer.
    """
    try:
        probe = subprocess.run(
            interpreter.command(_CHILD, [address, limit]),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=_START + limit,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"no process could look at it: {error.__class__.__name__}"
    answer = probe.stdout.decode("utf-8", "replace").rpartition("\n")[2]
    if not answer.startswith(_ANSWER):
        return f"Dask died of it (exit code {probe.returncode})"
    return answer.removeprefix(_ANSWER)


def main(address: str, limit: float) -> None:
    """Check the address, print the reason, and end at once; for the process of its own."""
    import distributed

    dask: Any = distributed
    silence = threading.Timer(limit, _end, [f"nothing that answers within {limit:g} s"])
    silence.daemon = True
    silence.start()
    try:
        client = dask.Client(address, timeout=_OF_IT * limit, set_as_default=False)
        client.nthreads()
    except MemoryError:
        _end("it speaks another protocol than Dask's")
    except TypeError as error:  # Dask's own error about missing certificates
        _end(f"{_short(error)}; tls needs Dask's distributed.comm.tls settings")
    except BaseException as error:
        _end(_short(error) or type(error).__name__)
    _end("")


def _short(error: BaseException) -> str:
    return " ".join(str(error).split())[:_LONGEST]


def _end(reason: str) -> NoReturn:
    """End without closing or deleting anything, since that may hang or print."""
    os.write(1, f"\n{_ANSWER}{reason}".encode())
    os._exit(0)
