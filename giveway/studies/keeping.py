"""The keeping of runs: what a session finds in a folder, adds to it, and tells about it."""

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from giveway.gate import fingerprint, signed
from giveway.results.provenance import processor, software_versions
from giveway.studies.execution import Executor
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.folder_contents import MANIFEST, broken_files, read_manifest
from giveway.studies.folder.lock import remove_derived_files, remove_study
from giveway.studies.folder.sealing import BrokenFileError, put_aside, sealed
from giveway.studies.folder.store import RecordStore
from giveway.studies.identity import differences, relevant_versions, software_identity
from giveway.studies.record import RunRecord, Task


class Keeper:
    """The records in a folder, during one session.

    Args:
        out: Folder of the study or risk.
        file: Name of the file with the definition.
        definition: Text of the definition.
        tell: Function that takes one line for each kept file that is broken, and when runs of
            another giveway version are made again. None for standard error.
    """

    def __init__(
        self, out: Path, file: str, definition: str, tell: Callable[[str], None] | None
    ) -> None:
        self._out, self._file, self._definition = out, file, definition
        self.tell = tell or _to_stderr
        self._software = software_identity()
        self._store = RecordStore(out, self._software)
        self._processors: set[str] = set()  # of which the user has been told

    def begin(self, *, force: bool) -> None:
        """Write the definition, and remove tables and report of a former session.

        Args:
            force: True to remove everything that is in the folder.
        """
        if force:
            remove_study(self._out)
        for file in broken_files(self._out):
            there = put_aside(file, self._out)
            self.tell(f"{file}: is not what giveway wrote; put aside in {there}, it is made again")
        with suppress(OSError, KeyError):
            manifest = read_manifest(self._out)
            before = manifest["identity"]
            if before != self._software:
                differ = differences(relevant_versions(manifest["software"]))
                self.tell(
                    f"{self._out}: its runs were made by another giveway, other libraries or a "
                    f"machine of another kind (identity {before}, now {self._software}: {differ}); "
                    "they are made again"
                )
        remove_derived_files(self._out)
        write_atomically(self._out / self._file, self._definition, durable=True)

    def write_manifest(self, content: Mapping[str, Any], cells: Sequence[Any]) -> None:
        """Write the manifest with the seal, the definition's checksum and the software.

        Args:
            content: First entries of the manifest.
            cells: Entry of each cell.
        """
        whole = {
            **content,
            "identity": self._software,
            "definition": fingerprint(self._definition.encode("utf-8")),
            "cells": cells,
            "software": dict(software_versions()),
        }
        text = json.dumps(signed(sealed(whole, self._software)), indent=2, ensure_ascii=False)
        write_atomically(self._out / MANIFEST, text + "\n", durable=True)

    def kept(self, key: str) -> RunRecord | None:
        """Return the record of a run that has been made.

        A broken record is reported and put aside.
        """
        try:
            record = self._store.get(key)
        except BrokenFileError as error:
            there = put_aside(error.file, self._out)
            self.tell(
                f"{error.file}: is not what giveway wrote ({error.reason}); put aside in {there}, "
                "the run is made again"
            )
            return None
        if record is not None:
            self._tell_processor(record)
        return record

    def make(self, executor: Executor, tasks: Iterable[Task]) -> Iterator[RunRecord]:
        """Make runs, and yield each record as soon as it is kept."""
        for record in executor.run(tasks):
            self._store.put(record)
            self._tell_processor(record)
            if record.computing.retried and not record.failed:
                self.tell(f"{record.run}: {record.computing.retried}; another process has made it")
            yield record

    def _tell_processor(self, record: RunRecord) -> None:
        """Tell the user once of each processor, other than this one, that has made a run."""
        name, here = record.computing.processor, processor()["name"]
        if name not in {"", here, *self._processors}:
            self._processors.add(name)
            self.tell(
                f"{record.run}: made on another processor ({name}; here {here}); the bytes are the "
                "same (docs/results.md)"
            )


def _to_stderr(line: str) -> None:
    sys.stderr.write(f"note: {line}\n")
