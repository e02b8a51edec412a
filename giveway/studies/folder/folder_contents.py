"""The files of a study's folder besides its records, and the check that they are unchanged.

The manifest is sealed and holds the definition's checksum. The data package is sealed and holds
those of the tables.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from giveway.gate import RefusedFileError, definition_name, fingerprint, fingerprint_of, read_bytes
from giveway.studies.folder.sealing import (
    SEAL,
    BrokenFileError,
    read_json,
    read_sealed,
)

DEFINITION = "study.toml"
MANIFEST = "manifest.json"
PACKAGE = "datapackage.json"
# Keys of the manifest that its seal covers
_SEALED = {"study", "seeds", "complete", "identity", "definition", "cells"}
SHA256 = "sha256:"  # Prefix of a checksum in a data package


def broken_files(study: Path) -> list[Path]:
    """Return the existing files of a study, except records, that differ from what was written."""
    found = broken_tables(study)
    try:
        require_definition(study, read_manifest(study))
    except BrokenFileError as error:
        found.append(error.file)
    except OSError:  # the study was killed before a file was written
        pass
    return found


def read_manifest(study: Path) -> dict[str, Any]:
    """Return the manifest of a study, without its seal.

    A manifest of an earlier giveway has no seal.

    Raises:
        BrokenFileError: it differs from what was written.
        OSError: it cannot be read.
    """
    file = study / MANIFEST
    manifest = read_json(file)
    if not {SEAL, "definition"} & manifest.keys():
        return manifest
    manifest = read_sealed(file)
    if not manifest.keys() >= _SEALED:
        raise BrokenFileError(file, "it is not a manifest")
    return manifest


def require_definition(study: Path, manifest: dict[str, Any]) -> None:
    """Make sure that a study's definition is the one whose checksum the manifest holds.

    Raises:
        BrokenFileError: it is another one.
        OSError: it cannot be read.
    """
    file = study / definition_name(manifest)
    known = manifest.get("definition")
    try:
        changed = known is not None and known != fingerprint(read_bytes(file))
    except RefusedFileError as error:
        raise BrokenFileError(file, f"it {error.reason}") from None
    if changed:
        raise BrokenFileError(
            file, f"{MANIFEST} is about another, as after a kill in the beginning"
        )


def intact_tables(study: Path) -> frozenset[str]:
    """Return the names of the tables in a study's folder that are unchanged."""
    try:
        return frozenset(name for name, intact in _tables(study) if intact)
    except (BrokenFileError, OSError):
        return frozenset()


def broken_tables(study: Path) -> list[Path]:
    """Return the changed tables in a study's folder, and their description if it has changed.

    Missing tables do not count. Neither do those of an earlier giveway, which did not seal them.
    """
    try:
        if SEAL not in read_json(study / PACKAGE):
            return []
        return [study / name for name, intact in _tables(study) if not intact]
    except BrokenFileError as error:
        return [error.file]
    except OSError:
        return []


def _tables(study: Path) -> Iterator[tuple[str, bool]]:
    """Yield each existing table, and whether it matches its description.

    Raises:
        BrokenFileError: the description has changed or is another file.
        OSError: it cannot be read.
    """
    file = study / PACKAGE
    try:
        described = {
            table["path"]: {"bytes": table["bytes"], "sha256": table["hash"].removeprefix(SHA256)}
            for table in read_sealed(file)["resources"]
        }
    except (KeyError, TypeError):
        raise BrokenFileError(file, "it is not a description of tables") from None
    for name, known in described.items():
        try:
            yield name, fingerprint_of(study / name) == known
        except RefusedFileError:
            yield name, False
        except OSError:  # it is missing
            continue
