"""The finished runs of a study on disk, one file each."""

import json
from pathlib import Path
from typing import Any

from giveway.errors import ResultsError
from giveway.gate import RefusedFileError, require_no_link
from giveway.studies.folder.atomic_files import write_atomically
from giveway.studies.folder.sealing import BrokenFileError, read_json, read_sealed, sealed
from giveway.studies.record import RunRecord

RECORDS = "records"


class RecordStore:
    """Records by key, in ``records/<first two letters>/<key>.json``.

    A record is written under another name, flushed to the disk and renamed. Therefore a file with a
    record's name is complete, even after a crash of the machine. A lock on the study's folder makes
    sure that no other process writes there. A later change of the file breaks its seal.

    Args:
        folder: Folder of the study.
        software: Identity of the code that makes the records, or None if an earlier giveway, which
            did not seal records, has written the study.
    """

    def __init__(self, folder: Path, software: str | None) -> None:
        self._folder = folder / RECORDS
        self._software = software

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / f"{key}.json"

    def get(self, key: str) -> RunRecord | None:
        """Return the record, or None if the run has not been made yet.

        Raises:
            BrokenFileError: the file differs from what was written.
            ResultsError: it cannot be read.
        """
        path = self._path(key)
        try:
            require_no_link(path, self._folder.parent)
            content = read_json(path) if self._software is None else self._sealed(path)
            record = RunRecord.from_values(content)
        except FileNotFoundError:
            return None
        except RefusedFileError as error:
            raise BrokenFileError(error.file, f"it {error.reason}") from None
        except IsADirectoryError:
            raise BrokenFileError(path, "it is a folder") from None
        except ValueError as error:
            raise BrokenFileError(path, str(error)) from None
        except OSError as error:
            raise ResultsError(
                f"{path}: cannot be read ({error.strerror}); check the disk"
            ) from error
        if record.key != key:
            raise BrokenFileError(path, f"it is the record {record.key!r}")
        return record

    def _sealed(self, path: Path) -> dict[str, Any]:
        return read_sealed(path, software=self._software)

    def put(self, record: RunRecord) -> None:
        """Keep the record of a finished run, which is on the disk when this returns.

        Raises:
            ResultsError: the disk is full or not writable.
        """
        assert self._software is not None  # no run is added to a study of an earlier giveway
        content = sealed(json.loads(record.to_json()), self._software)
        text = json.dumps(content, ensure_ascii=False, allow_nan=False) + "\n"
        path = self._path(record.key)
        write_atomically(path, text, within=self._folder.parent, durable=True)
