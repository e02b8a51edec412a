"""Names for added persons that no person of the scenario has, however late it departs."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from giveway.scenario_files.reading import pieces

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_DECLARATION = re.compile(rb"<(?:person|personFlow)\s[^>]*?\bid\s*=\s*[\"']([^\"']*)")


def free_prefix(wanted: str, files: Iterable[Path]) -> str:
    """``wanted``, or a longer prefix with which no person's id begins in any of ``files``.

    Args:
        wanted: names are to be this with a number.
        files: everything that SUMO reads, compressed or not.
    """
    names: set[bytes] = set()
    start = wanted.encode()
    try:
        for file in files:
            for text in pieces(file):
                found = (match[1] for match in _DECLARATION.finditer(text))
                names.update(name for name in found if start in name)
    except (OSError, EOFError):
        return wanted  # SUMO will say what is wrong with the file
    prefix = wanted
    while any(name.startswith(prefix.encode()) for name in names):
        prefix = f"added_{prefix}"
    return prefix
