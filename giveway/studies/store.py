"""The finished runs of a study on disk, one file each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.errors import ResultsError
from giveway.studies.atomic_files import write_atomically
from giveway.studies.record import RunRecord

if TYPE_CHECKING:
    from pathlib import Path

RECORDS = "records"


class RecordStore:
    """Records by key, in ``records/<first two letters>/<key>.json``.

    A record is written under another name, flushed to the disk and renamed. A file with a
    record's name is thus complete, even after a crash of the machine. A lock on the study's
    folder makes sure that no other process writes.

    Args:
        folder: of the study.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder / RECORDS

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / f"{key}.json"

    def get(self, key: str) -> RunRecord | None:
        """The record, or None: the run is yet to be made.

        A file that cannot be understood, as a failing disk or an editor may leave it, counts as
        missing.
        """
        try:
            record = RunRecord.from_json(self._path(key).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        except OSError as error:
            raise ResultsError(
                f"{self._path(key)}: cannot be read ({error.strerror}); mend the disk"
            ) from error
        return record if record.key == key else None

    def put(self, record: RunRecord) -> None:
        """Keep a finished run; it counts from the moment this returns.

        Raises:
            ResultsError: the disk is full or not writable.
        """
        write_atomically(self._path(record.key), record.to_json() + "\n", durable=True)
