"""Seals, by which a study notices that one of its files has changed.

A sealed file is JSON with one more entry: length and SHA-256 of all others, and the identity of the
code that wrote them. For a file that is not JSON, such as a table, a sealed file holds length and
checksum.
"""

import json
from pathlib import Path
from typing import Any

from giveway import gate
from giveway.errors import ResultsError

SEAL = "seal"
ASIDE = "broken"  # Name of the folder for files whose seal is broken


class BrokenFileError(ResultsError):
    """A file of a study differs from what was written.

    Args:
        file: Path of the file.
        reason: Reason why it is refused.

    Attributes:
        file: Path of the file.
        reason: Reason why it is refused.
    """

    def __init__(self, file: Path, reason: str) -> None:
        self.file, self.reason = file, reason
        super().__init__(
            f"{file}: is not what giveway wrote ({reason}); giveway study with --resume puts it "
            "aside and makes it again"
        )


def sealed(content: dict[str, Any], software: str) -> dict[str, Any]:
    """Return ``content`` with its seal.

    Args:
        content: Content of a JSON file.
        software: Identity of the code that made it.
    """
    return content | {SEAL: _seal(content, software)}


def read_sealed(file: Path, *, software: str | None = None) -> dict[str, Any]:
    """Return the content of a sealed file, without its seal.

    Args:
        file: File to be read.
        software: Identity of the code that must have made it, or None for any code.

    Raises:
        BrokenFileError: it differs from what was written, or other code wrote it.
        OSError: it cannot be read.
    """
    content = read_json(file)
    content.pop(gate.MAKER, None)
    seal = content.pop(SEAL, None)
    if seal is None:
        raise BrokenFileError(file, "its seal is missing")
    maker = seal.get("software") if isinstance(seal, dict) else None
    if seal != _seal(content, maker):
        raise BrokenFileError(file, "length or checksum differ from its seal")
    if software not in (None, maker):
        raise BrokenFileError(file, f"made by software {maker}; expected {software}")
    return content


def read_json(file: Path) -> dict[str, Any]:
    """Return the content of a JSON file with its seal, which is not checked.

    Raises:
        BrokenFileError: the file is not JSON.
        OSError: it cannot be read.
    """
    try:
        return gate.read_json(file)
    except gate.RefusedFileError as error:
        raise BrokenFileError(file, f"it {error.reason}") from None


def put_aside(file: Path, study: Path) -> Path:
    """Move a broken file into a folder of its own, so that it can be examined.

    Args:
        file: File of the study.
        study: Folder of the study.

    Returns:
        The new path of the file.

    Raises:
        ResultsError: the file cannot be moved.
    """
    there = study / ASIDE / file.relative_to(study)
    gate.require_no_link(there, study)
    try:
        there.parent.mkdir(parents=True, exist_ok=True)
        return file.replace(there)
    except OSError as error:
        raise ResultsError(
            f"{file}: is broken and cannot be moved to {there} ({error.strerror}); remove it and "
            "go on with --resume"
        ) from error


def _seal(content: dict[str, Any], software: Any) -> dict[str, Any]:
    text = json.dumps(content, sort_keys=True)
    return {**gate.fingerprint(text.encode("ascii")), "software": software}
