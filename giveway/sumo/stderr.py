"""The output of SUMO on the process's own stderr, which is kept in a file and read back."""

import os
import re
import tempfile
from collections.abc import Container
from pathlib import Path
from typing import IO

# Warnings about people that name nobody else
_ABOUT = tuple(
    map(
        re.compile,
        (
            r"^Warning: Collision of person '([^']*)' and person '([^']*)'",
            r"^Warning: Person '([^']*)' suddenly appeared inside detector",
            r"^Warning: Person '([^']*)' entered crossing lane .* without registering approach",
            r"^Warning: Invalid departPos .* given for person '([^']*)'",
            r"^Warning: Could not map position .* for person '([^']*)'",
        ),
    )
)


def of_others(text: str, ours: Container[str]) -> str:
    """Return the output of SUMO without warnings about how giveway moves people.

    In SUMO's records people meet whom giveway keeps far apart, and appear before detectors.

    Args:
        text: Output of SUMO.
        ours: Ids of the persons that giveway added or has taken over.
    """

    def is_news(line: str) -> bool:
        found = (about.match(line) for about in _ABOUT)
        return not any(about and all(name in ours for name in about.groups()) for about in found)

    return "".join(filter(is_news, text.splitlines(keepends=True)))


class NativeStderr:
    """Redirects file descriptor 2 into a file while a native call runs.

    The object itself is the context manager, for one call at a time. Call ``close`` at the end.

    Args:
        path: Path of the file, which can be read after this process has died, or None for a
            temporary file without a name.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._log: IO[bytes]
        if path is None:
            self._log = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the session
        else:
            self._log = path.open("w+b")
        self._file_descriptor = self._log.fileno()
        try:
            self._saved = os.dup(2)
        except OSError:  # stderr is closed, and its output is lost
            self._saved = os.open(os.devnull, os.O_WRONLY)

    def __enter__(self) -> None:
        os.dup2(self._file_descriptor, 2)

    def __exit__(self, *_: object) -> None:
        os.dup2(self._saved, 2)

    def text(self) -> str:
        """The output so far."""
        self._log.seek(0)
        return self._log.read().decode("utf-8", "replace")

    def errors(self) -> str:
        """The reasons for errors in the output, on one line."""
        lines = [line.strip() for line in self.text().splitlines()]
        reasons = [
            line.removeprefix("Error:").strip()
            for line in lines
            if line and not line.startswith(("Warning", "Quitting", "Loading"))
        ]
        return "; ".join(dict.fromkeys(reasons))

    def close(self) -> None:
        """Close the file; its content is lost if it is a temporary one."""
        os.close(self._saved)
        self._log.close()
