"""The results folder: tables, summary, manifest, data package, configuration and pictures."""

import contextlib
import json
import shutil
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from giveway.errors import ResultsError, remedy
from giveway.gate import MANIFEST, read_bytes
from giveway.processes.locks import FolderInUseError, locked
from giveway.results.json_text import DECIMALS, json_text
from giveway.results.names import FILES, LONGEST, SUMO_FOLDER
from giveway.results.run_tables import RunTables
from giveway.results.scene import scene_of
from giveway.results.table_files import write_csv, write_parquet
from giveway.run_data.columns import Column
from giveway.run_data.scene import SCENE_FILE
from giveway.run_data.seal import Form, sealed

if TYPE_CHECKING:
    import pandas as pd

_PACKED: dict[Form, dict[str, str]] = {
    "csv": {},
    "csv.gz": {"compression": "gz"},
    "parquet": {"format": "parquet", "mediatype": "application/vnd.apache.parquet"},
}
_RUNNING = '{"ending": "running"}\n'


class Wording(NamedTuple):
    """The words that a message uses to advise its reader: flags or arguments."""

    force: str
    folder: str


FLAGS = Wording("--force", "--out")
ARGUMENTS = Wording("force=True", "out=")


class Destination(NamedTuple):
    """The folder of a run's results, and the files that are written to it."""

    folder: Path | None = None  # None if nothing is written
    force: bool = False  # True to replace existing results
    parquet: bool = False  # True to write the tables also as Parquet
    trajectories: Form = "csv"  # form of the longest table
    pictures: bool = True  # True to draw the state figure and the top view
    wording: Wording = FLAGS  # wording of messages


NOWHERE = Destination()


def check_folder(
    folder: Path,
    *,
    force: bool,
    ours: Collection[str] = FILES,
    writer: str = "giveway",
    wording: Wording = FLAGS,
) -> None:
    """Make sure that the results may go to ``folder``, without a change to it.

    Args:
        folder: Folder for the results.
        force: True if former results may be replaced.
        ours: Names of the files that may be there.
        writer: Program that writes them, for messages.
        wording: Words of the caller, for messages.

    Raises:
        ResultsError: the folder exists and ``force`` is not given, it is a file, or it holds files
            that the writer did not write.
    """
    try:
        folder.stat()
        present = sorted(path.name for path in folder.iterdir())
    except FileNotFoundError:
        return
    except NotADirectoryError:
        raise ResultsError(
            f"{folder}: is a file, or below one; expected a folder for the results, name another "
            f"with {wording.folder}"
        ) from None
    except OSError as error:
        raise _unusable(folder, error, wording) from error
    foreign = [name for name in present if name not in ours]
    if foreign:
        raise ResultsError(
            f"{folder}: holds '{foreign[0]}', which {writer} did not write; "
            f"name another folder with {wording.folder}"
        )
    if not force and is_marked_only(folder):
        raise ResultsError(
            f"{folder}: another run is writing there, or was killed ('giveway recover' lists the "
            f"rows of killed runs); name another folder with {wording.folder}, or replace it with "
            f"{wording.force}"
        )
    if present and not force:
        raise ResultsError(
            f"{folder}: results exist; replace them with {wording.force} or name another with "
            f"{wording.folder}"
        )


def is_marked_only(folder: Path) -> bool:
    """Return whether a run has taken ``folder`` without having written its results.

    Raises:
        OSError: the folder cannot be read.
    """
    if not folder.is_dir() or [path.name for path in folder.iterdir()] != ["manifest.json"]:
        return False
    return read_bytes(folder / "manifest.json") == _RUNNING.encode("ascii")


@contextlib.contextmanager
def taken_folder(folder: Path, *, force: bool, wording: Wording = FLAGS) -> Iterator[bool]:
    """Take ``folder`` for one run; former results stay until the new ones are written.

    Returns:
        True if the folder was taken empty, so that ``release_folder`` may undo it.

    Raises:
        ResultsError: as for ``check_folder``, or it cannot be written, or another run has taken it.
    """
    with contextlib.ExitStack() as stack:
        try:
            check_folder(folder, force=force, wording=wording)
            folder.mkdir(parents=True, exist_ok=True)
            stack.enter_context(locked(folder))
            empty = not any(folder.iterdir())
            if empty:
                with (folder / "manifest.json").open("x", encoding="utf-8") as marker:
                    marker.write(_RUNNING)
        except (FileExistsError, FolderInUseError):
            raise ResultsError(
                f"{folder}: another run is writing there; name another folder with {wording.folder}"
            ) from None
        except OSError as error:
            raise _unusable(folder, error, wording) from error
        yield empty


def _unusable(folder: Path, error: OSError, wording: Wording) -> ResultsError:
    return ResultsError(
        f"{folder}: cannot be written ({error.strerror}); name another folder with {wording.folder}"
    )


def release_folder(folder: Path) -> None:
    """Remove the folder that was taken for a run which could not begin."""
    shutil.rmtree(folder / SUMO_FOLDER, ignore_errors=True)
    with contextlib.suppress(OSError):
        (folder / "manifest.json").unlink()
        folder.rmdir()


def write_results(
    result: RunTables, folder: Path, *, parquet: bool = False, trajectories: Form = "csv"
) -> None:
    """Write everything except the pictures into ``folder``.

    Args:
        result: Result of the run.
        folder: Results folder.
        parquet: True to write all tables as Parquet, too.
        trajectories: Form of the longest table.

    Raises:
        ResultsError: the disk is full, or the folder is no longer writable.
    """
    tables: dict[str, Callable[[], Iterable[pd.DataFrame]]] = {
        name: partial(iter, [result.summary_table if name == "summary" else getattr(result, name)])
        for name in result.schemas.keys() - {LONGEST}
    }
    tables[LONGEST] = result.trajectory_pieces
    contents: dict[str, Callable[[Path], object]] = {"config.toml": _text(result.config_text)}
    for name in result.schemas:
        form = trajectories if name == LONGEST else "csv"
        for suffix in dict.fromkeys([form, "parquet"] if parquet else [form]):
            writer = write_parquet if suffix == "parquet" else write_csv
            contents[f"{name}.{suffix}"] = partial(writer, tables[name])
    contents["summary.json"] = _json(_summary(result))
    contents["datapackage.json"] = _json(data_package(result, trajectories))
    contents[SCENE_FILE] = _text(scene_of(result).to_json())
    if result.sumo_messages:
        contents["sumo.log"] = _text(result.sumo_messages)
    path = folder
    try:
        for name in FILES - {SUMO_FOLDER}:
            path = folder / name
            path.unlink(missing_ok=True)  # files of two runs are never mixed
        for name, write in contents.items():
            path = folder / name
            write(path)
        path = folder / MANIFEST  # written last: it marks complete results
        manifest = json.loads(json_text(result.manifest))
        _json(sealed(manifest, folder, contents))(path)
    except OSError as error:
        message = f"{path}: cannot be written ({error.strerror}); {remedy(error)}"
        _leave_incomplete(path, result.manifest | {"incomplete": message})
        raise ResultsError(message) from error


def _leave_incomplete(torn: Path, manifest: dict[str, Any]) -> None:
    """Remove a partly written file, and write a manifest that says what is missing, if possible."""
    with contextlib.suppress(OSError):
        torn.unlink(missing_ok=True)
        _json(manifest)(torn.with_name("manifest.json"))


def _summary(result: RunTables) -> dict[str, Any]:
    """Return the first ego's row, the other egos' rows, and the computing times."""
    rows = [_plain(row) for row in result.summary_rows]
    more = {"egos": rows} if len(rows) > 1 else {}
    return result.summary | more | {"timing": result.timing_summary}


def _plain(row: dict[Any, Any]) -> dict[str, Any]:
    """Return the row in Python's own types, which JSON knows."""
    return {str(k): v.item() if isinstance(v, np.generic) else v for k, v in row.items()}


def rounded_row(row: dict[Any, Any]) -> dict[str, Any]:
    """Return a row of a table as it is written: Python's own types, floats with six decimals."""
    return {
        key: round(value, DECIMALS) + 0.0 if isinstance(value, float) else value
        for key, value in _plain(row).items()
    }


def sumo_folder(folder: Path) -> Path:
    """Return the folder for SUMO's own outputs, after removing those of a former run.

    Raises:
        ResultsError: those files cannot be removed.
    """
    try:
        shutil.rmtree(folder / SUMO_FOLDER, ignore_errors=False)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise ResultsError(
            f"{error.filename or folder}: cannot be removed ({error.strerror}); name another --out"
        ) from error
    return folder / SUMO_FOLDER


def data_package(result: RunTables, trajectories: Form = "csv") -> dict[str, Any]:
    """Return the Frictionless description of a run's tables; one has the form ``trajectories``."""
    name = f"giveway-{result.scenario.name}-{result.config.seed}"
    title = f"giveway run of {result.scenario.name}, seed {result.config.seed}"
    package = package_of(name, title, result.schemas)
    for resource in package["resources"]:
        if resource["name"] == LONGEST:
            resource |= {"path": f"{LONGEST}.{trajectories}"} | _PACKED[trajectories]
    return package


def package_of(name: str, title: str, schemas: Mapping[str, Sequence[Column]]) -> dict[str, Any]:
    """Return the Frictionless description of CSV files: each column's type, unit and meaning.

    Args:
        name: Name of the package.
        title: Title of the package, for readers.
        schemas: Columns of each file, by its name without the suffix.
    """
    return {
        "profile": "tabular-data-package",
        "name": name.lower().replace("_", "-"),
        "title": title,
        "resources": [
            {
                "profile": "tabular-data-resource",
                "name": table,
                "path": f"{table}.csv",
                "format": "csv",
                "mediatype": "text/csv",
                "encoding": "utf-8",
                "schema": {"fields": _fields(columns), "missingValues": [""]},
            }
            for table, columns in schemas.items()
        ],
    }


def _fields(columns: Sequence[Column]) -> list[dict[str, str]]:
    """Return the columns as in the schema of a data package."""
    fields = []
    for column in columns:
        field = {"name": column.name, "type": column.type}
        if column.unit is not None:
            field["unit"] = column.unit
        fields.append(field | {"description": column.description})
    return fields


def _text(text: str) -> Callable[[Path], object]:
    return lambda path: path.write_text(text, encoding="utf-8")


def _json(content: dict[str, Any]) -> Callable[[Path], object]:
    return _text(json_text(content))
