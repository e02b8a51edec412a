"""The reservation of a study's folder: one process works there, and no other file is removed."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import filelock

from giveway.errors import ResultsError
from giveway.gate import DEFINITIONS, require_no_link
from giveway.studies.folder.atomic_files import finished_name
from giveway.studies.folder.folder_contents import MANIFEST, PACKAGE, read_manifest
from giveway.studies.folder.sealing import ASIDE, BrokenFileError
from giveway.studies.folder.store import RECORDS
from giveway.studies.folder.table_files import TABLES
from giveway.studies.study_options import StudyOptions

LOCK = ".lock"
REPORT = "report.html"
BENCHMARK = "benchmark.csv"
COURSE = "course"
"""Name of the folder with the road of tests, which is there before their study."""
NCAP_FILES = ("ncap.csv", "ncap.html")
RISK_TABLES = (
    "runs",
    "risk",
    "events",
    "stages",
    "severity",
    "why",
    "given_event",
    "likeliest",
    "failures",
)
_DERIVED_FILES = frozenset(
    {
        *(f"{name}.csv" for name in (*TABLES, *RISK_TABLES)),
        *NCAP_FILES,
        PACKAGE,
        REPORT,
        BENCHMARK,
    }
)
_STUDY_FILES = (
    frozenset({*DEFINITIONS.values(), MANIFEST, RECORDS, ASIDE, "figures", "replays", "reruns"})
    | _DERIVED_FILES
)


@contextmanager
def reserved(out: Path, study: str, options: StudyOptions) -> Iterator[None]:
    """Make sure that a study may be written to ``out``, and lock the folder.

    The folder's content is not changed.

    Args:
        out: The folder; it is made if it does not exist.
        study: Name of the study.
        options: Options that say whether it is to be resumed or replaced.

    Raises:
        ResultsError: the folder holds a study and neither resume nor force is given, or it holds
            another study or other files; another process works there; or the folder cannot be made.
    """
    _require_free(out, study, options)  # before a lock is put into a folder that is not the study's
    try:
        out.mkdir(parents=True, exist_ok=True)
        require_no_link(out / LOCK)
        lock = filelock.FileLock(out / LOCK, timeout=0)
        lock.acquire()
    except filelock.Timeout:
        raise ResultsError(
            f"{out}: another giveway study is at work there; wait for it, or name another --out"
        ) from None
    except OSError as error:
        raise ResultsError(
            f"{out}: cannot be written ({error.strerror}); name another folder with --out"
        ) from error
    try:
        _require_free(out, study, options)  # another process may have written there in the meantime
        yield
    finally:
        lock.release()


def _require_free(out: Path, study: str, options: StudyOptions) -> None:
    if not out.exists():
        return
    if not out.is_dir():
        raise ResultsError(
            f"{out}: is a file; expected a folder for the study, name another with --out"
        )
    present = {path.name for path in out.iterdir()} - {LOCK, COURSE}
    foreign = sorted(name for name in present if finished_name(name) not in _STUDY_FILES)
    beginning = not (options.resume and present & _STUDY_FILES)
    if foreign and beginning:  # other files do no harm to a study that is resumed
        raise ResultsError(
            f"{out}: holds '{foreign[0]}', which no study of giveway wrote; name another folder "
            "with --out"
        )
    if present and not (options.resume or options.force):
        raise ResultsError(
            f"{out}: a study is there; go on with it by --resume, replace it by --force, or name "
            "another folder with --out"
        )
    there = _name_of(out)
    if options.resume and there not in {None, study}:
        raise ResultsError(
            f"{out}: holds the study '{there}'; expected '{study}' to go on with; replace it by "
            "--force, or name another folder with --out"
        )


def _name_of(out: Path) -> str | None:
    """Return the name of the study in the folder.

    It is None if there is no study or its manifest is broken.
    """
    try:
        return str(read_manifest(out)["study"])
    except (OSError, BrokenFileError, KeyError):
        return None


def remove_study(out: Path) -> None:
    """Remove every file of a study.

    Raises:
        ResultsError: a file cannot be removed.
    """
    _remove(out, _STUDY_FILES)


def remove_derived_files(out: Path) -> None:
    """Remove tables and report, which will be made again from more records.

    Raises:
        ResultsError: a file cannot be removed.
    """
    _remove(out, _DERIVED_FILES)


def _remove(out: Path, names: frozenset[str]) -> None:
    for path in sorted(out.iterdir()):
        if finished_name(path.name) not in names:
            continue
        try:
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
        except OSError as error:
            raise ResultsError(
                f"{path}: cannot be removed ({error.strerror}); name another folder with --out"
            ) from error
