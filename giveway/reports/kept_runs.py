"""The runs that a report keeps, so that the next report need not make them again."""

import functools
import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from giveway.errors import ResultsError, remedy
from giveway.gate import (
    LARGEST_TABLE,
    MAKER,
    fingerprint_of,
    is_own,
    read_bytes,
    read_json,
    require_no_link,
    signed,
    write_whole,
)
from giveway.reports.examples import Drive
from giveway.run_data.tracks import EgoTrack
from giveway.studies.repeated_run import Runs

REPLAYS = "replays"
_LIST = "kept.json"
_COLUMNS = tuple(field.name for field in fields(EgoTrack))


class KeptRuns:
    """Pages and drives of runs, in the folder ``replays`` of a study.

    A list beside them has, for each run, the key of its record, the code that drew its page, and
    the SHA-256 of both files. Files that do not match their line are not used, and a list that
    this user's key has not signed is none.

    Args:
        study: Study or risk that has the runs.
    """

    def __init__(self, study: Runs) -> None:
        self._study = study
        self._folder = study.path / REPLAYS
        self._list: dict[str, Any] = {}
        try:
            kept = read_json(self._folder / _LIST, within=study.path)
        except (FileNotFoundError, NotADirectoryError):
            return
        if is_own(kept):  # a page runs scripts in the reader's browser
            del kept[MAKER]
            self._list = kept

    def has(self, run: str) -> bool:
        """Return whether page and drives of a run exist and were made from the study's record."""
        try:
            return bool(self._list.get(run) == self._line(run))
        except OSError:
            return False

    def page(self, run: str) -> Path:
        """Return the path of the page that plays a run."""
        return self._folder / f"{run}.html"

    def drives(self, run: str) -> list[Drive]:
        """Return the drives of a run's egos.

        Raises:
            LookupError: the drives are not kept.
        """
        try:
            content = read_bytes(self._drives(run), within=self._study.path, largest=LARGEST_TABLE)
            with np.load(io.BytesIO(content), allow_pickle=False) as kept:
                about = json.loads(str(kept["egos"]))
                return [
                    Drive(name, EgoTrack(**{c: kept[f"{i}_{c}"] for c in _COLUMNS}), safe, buffer)
                    for i, (name, safe, buffer) in enumerate(about)
                ]
        except (OSError, BadZipFile, KeyError, ValueError, TypeError) as error:
            raise LookupError(f"no drives of run {run} are kept") from error

    def keep(self, run: str, drives: Sequence[Drive]) -> None:
        """Keep the drives of a run whose page has been written.

        Raises:
            ResultsError: the disk is full.
        """
        columns: dict[str, Any] = {
            f"{i}_{name}": getattr(drive.track, name)
            for i, drive in enumerate(drives)
            for name in _COLUMNS
        }
        about = [(drive.ego, drive.safe_distance, drive.buffer_distance) for drive in drives]
        with self._told():
            content = io.BytesIO()
            np.savez_compressed(content, egos=np.array(json.dumps(about)), **columns)
            write_whole(self._drives(run), content.getvalue(), within=self._study.path)
            self._list[run] = self._line(run)
            self._write()

    def only(self, runs: Iterable[str]) -> None:
        """Remove the files of all other runs.

        Raises:
            ResultsError: the folder cannot be written.
        """
        shown = set(runs)
        require_no_link(self._folder / _LIST, self._study.path)
        with self._told():
            for path in self._folder.glob("*"):
                if path.suffix in {".html", ".npz"} and path.stem not in shown:
                    path.unlink(missing_ok=True)
            if self._list.keys() - shown:
                self._list = {run: line for run, line in self._list.items() if run in shown}
                self._write()

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise ResultsError(
                f"{error.filename or self._folder}: cannot be written ({error.strerror}); "
                f"{remedy(error)}"
            ) from error

    def _drives(self, run: str) -> Path:
        return self._folder / f"{run}.npz"

    def _line(self, run: str) -> dict[str, str]:
        return {
            "record": self._study.key_of(run),
            "drawn by": page_code(),
            "page": fingerprint_of(self.page(run))["sha256"],
            "drives": fingerprint_of(self._drives(run))["sha256"],
        }

    def _write(self) -> None:
        text = json.dumps(signed(self._list), indent=1, sort_keys=True) + "\n"
        write_whole(self._folder / _LIST, text.encode("utf-8"), within=self._study.path)


@functools.cache
def page_code() -> str:
    """Return a hash of the code that turns results into a page.

    A run's record does not change with that code.
    """
    digest = hashlib.sha256()
    for path in _code(files("giveway.replays")):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def _code(folder: Traversable) -> Iterable[Traversable]:
    for path in sorted(folder.iterdir(), key=lambda path: path.name):
        if path.is_dir() and path.name != "__pycache__":
            yield from _code(path)
        elif path.is_file():
            yield path
