"""The files to which a scenario's files refer."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from giveway.scenario_files.configuration import located
from giveway.scenario_files.reading import pieces

READS: Final = {"include": "href", "calibrator": "file", "variableSpeedSign": "file"} | {
    "rerouter": "file"
}
"""Attribute that names a further file with elements, by element."""

_REFERENCE = re.compile(
    rb"<(%s)\s[^>]*?\b(href|file)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')"
    % b"|".join(name.encode() for name in READS)
)


def with_included(files: Iterable[Path]) -> list[Path]:
    """Return the files and all existing files that they refer to, directly or not, each once.

    A file that cannot be read counts as referring to none; its next reader reports the error.
    """
    found = list(files)
    known = {file.resolve() for file in found}
    for file in found:  # the list grows during the loop
        for there in _referred(file):
            if there.is_file() and there.resolve() not in known:
                known.add(there.resolve())
                found.append(there)
    return found


def _referred(file: Path) -> list[Path]:
    names = []
    try:
        for text in pieces(file):
            for element, attribute, double, single in _REFERENCE.findall(text):
                if READS[element.decode()] == attribute.decode():
                    names.append((double or single).decode("utf-8", "replace"))
    except (OSError, EOFError):
        return []
    return [located(name, file) for name in names if name]
