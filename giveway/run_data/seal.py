"""The seal of a results folder, by which changed, cut, swapped and foreign tables are noticed.

The manifest has length and SHA-256 of every file that was written before it, and a checksum of
itself. It is signed by the key of the user who made the run.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from giveway.errors import ResultsError
from giveway.gate import MAKER, MANIFEST, RefusedFileError, fingerprint_of, signed

SEAL: Final = "seal"
Form = Literal["csv", "csv.gz", "parquet"]
"""Form of the longest table."""
_TABLES: Final = frozenset({".csv", ".gz", ".parquet"})


class Fault(NamedTuple):
    """A file of a results folder that is not what the run wrote."""

    file: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.file}: {self.reason}"


def sealed(manifest: dict[str, Any], folder: Path, names: Iterable[str]) -> dict[str, Any]:
    """Return the manifest of a run with the seal of its files, signed by the user.

    Args:
        manifest: Manifest in types of JSON, with numbers as they are written.
        folder: Results folder.
        names: Names of the files in the folder that are sealed; all are complete.
    """
    files = {name: fingerprint_of(folder / name) for name in sorted(names)}
    seal = {"files": files, "sha256": _checksum(manifest, files)}
    return signed(manifest | {SEAL: seal})


def is_sealed(manifest: Mapping[str, Any]) -> bool:
    """Return whether a run has a seal; those of an earlier giveway have none."""
    return SEAL in manifest or MAKER in manifest


def faults(folder: Path, manifest: Mapping[str, Any]) -> list[Fault]:
    """Return the files of a sealed run that are not what it wrote; empty if all is well.

    Args:
        folder: Results folder.
        manifest: Content of its manifest, which has a seal.
    """
    seal, rest = manifest.get(SEAL), {k: v for k, v in manifest.items() if k not in (SEAL, MAKER)}
    files = seal.get("files") if isinstance(seal, dict) else None
    if not isinstance(seal, dict) or not isinstance(files, dict):
        return [Fault(folder / MANIFEST, "has a broken seal")]
    found = []
    if seal.get("sha256") != _checksum(rest, files):
        found.append(Fault(folder / MANIFEST, "was changed after the run"))
    for name, known in files.items():
        if Path(name).name == name:
            reason = _changed(folder / name, known)
            found += [Fault(folder / name, reason)] if reason else []
    more = {path.name for path in folder.iterdir() if path.suffix in _TABLES} - files.keys()
    return found + [Fault(folder / name, "was not written by this run") for name in sorted(more)]


def require_sealed(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Make sure that the tables of a run are those that it wrote, if it has a seal.

    Raises:
        ResultsError: a file is another one; the message names the first one.
    """
    found = faults(folder, manifest) if is_sealed(manifest) else []
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        raise ResultsError(
            f"{found[0]}{more}; expected the run's own files, as sealed in {MANIFEST}; copy the "
            "folder again or make the run again, or use it as it is with --unsealed"
        )


def _changed(file: Path, known: Any) -> str:
    """Return how a file differs from its entry in the seal, or "" if it does not."""
    try:
        found = fingerprint_of(file)
    except RefusedFileError as error:
        return error.reason
    except FileNotFoundError:
        return "" if file.suffix == ".parquet" or file.stem == "predictions" else "is missing"
    except OSError as error:
        return f"cannot be read ({error.strerror})"
    if found == known:
        return ""
    length = known.get("bytes") if isinstance(known, dict) else None
    if isinstance(length, int) and length != found["bytes"]:
        return f"has {found['bytes']:,} bytes, the run wrote {length:,}"
    return "has another content than the run wrote"


def _checksum(manifest: Mapping[str, Any], files: Mapping[str, Any]) -> str:
    text = json.dumps([manifest, files], sort_keys=True)
    return hashlib.sha256(text.encode("ascii")).hexdigest()
