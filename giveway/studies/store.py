"""The finished runs of a study on disk, one file each: there whole, or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.errors import ResultsError
from giveway.studies.atomic_files import write_whole
from giveway.studies.record import RunRecord

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

RECORDS = "records"


class RecordStore:
    """Records by key, in ``records/<first two letters>/<key>.json``.

    A record is written beside its place, given to the disk and renamed: whenever the process or
    the machine dies, a record that has its name is complete. Nobody else writes: a lock on the
    study's folder sees to that.

    Args:
        folder: of the study.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder / RECORDS

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / f"{key}.json"

    def get(self, key: str) -> RunRecord | None:
        """The record, or None: the run is yet to be made.

        A file that cannot be understood, which only a failing disk or an editor leaves, counts as
        not being there.
        """
        try:
            record = RunRecord.from_json(self._path(key).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None
        except OSError as error:
            msg = f"{self._path(key)}: cannot be read ({error.strerror}); mend the disk"
            raise ResultsError(msg) from error
        return record if record.key == key else None

    def put(self, record: RunRecord) -> None:
        """Keep a finished run; it counts from the moment this returns.

        Raises:
            ResultsError: the disk is full or not writable.
        """
        write_whole(self._path(record.key), record.to_json() + "\n", durable=True)

    def keys(self) -> Iterator[str]:
        """Of every record, also of those that no plan asks for any more."""
        for path in sorted(self._folder.glob("*/*.json")):
            yield path.stem
