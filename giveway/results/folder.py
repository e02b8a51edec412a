"""The results folder: tables, summary, manifest, data package, configuration and pictures."""

from __future__ import annotations

import contextlib
import json
import math
import shutil
from typing import TYPE_CHECKING, Any

import numpy as np

from giveway.errors import ResultsError
from giveway.records.scene import SCENE_FILE
from giveway.results.names import FILES, SUMO_FOLDER
from giveway.results.scene import scene_of

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from pathlib import Path

    import pandas as pd

    from giveway.records.columns import Column
    from giveway.results.run_result import RunResult

_RUNNING = '{"ending": "running"}\n'
_DECIMALS = 6  # micrometres, microseconds: finer than anything that is compared


def check_folder(
    folder: Path, *, force: bool, ours: Collection[str] = FILES, writer: str = "giveway"
) -> None:
    """Make sure that the results may go to ``folder``; nothing is changed.

    Args:
        folder: where they would go.
        force: whether former results may be replaced.
        ours: the names of the files that may be there.
        writer: the program that writes them, for messages.

    Raises:
        ResultsError: it exists and ``force`` is not given, it is a file, or it holds files that
            the writer did not write.
    """
    if not folder.exists():
        return
    if not folder.is_dir():
        raise ResultsError(
            f"{folder}: is a file; expected a folder for the results, name another with --out"
        )
    present = sorted(path.name for path in folder.iterdir())
    foreign = [name for name in present if name not in ours]
    if foreign:
        raise ResultsError(
            f"{folder}: holds '{foreign[0]}', which {writer} did not write; "
            "name another folder with --out"
        )
    marker = folder / "manifest.json"
    if present == [marker.name] and not force and marker.read_text("utf-8") == _RUNNING:
        raise ResultsError(
            f"{folder}: another run is writing there, or was killed; name another folder with "
            "--out, or replace it with --force"
        )
    if present and not force:
        raise ResultsError(
            f"{folder}: results exist; replace them with --force or name another with --out"
        )


def take_folder(folder: Path, *, force: bool) -> bool:
    """Take ``folder`` for a run; former results stay until the new ones are written.

    Returns:
        Whether the folder was taken empty, so that ``release_folder`` may undo it.

    Raises:
        ResultsError: as ``check_folder``, or it cannot be written, or another run has taken it.
    """
    try:
        check_folder(folder, force=force)
        folder.mkdir(parents=True, exist_ok=True)
        if any(folder.iterdir()):
            return False
        with (folder / "manifest.json").open("x", encoding="utf-8") as marker:
            marker.write(_RUNNING)
    except FileExistsError:
        raise ResultsError(
            f"{folder}: another run is writing there; name another folder with --out"
        ) from None
    except OSError as error:
        raise ResultsError(
            f"{folder}: cannot be written ({error.strerror}); name another folder with --out"
        ) from error
    return True


def release_folder(folder: Path) -> None:
    """Remove the folder that was taken for a run which could not begin."""
    shutil.rmtree(folder / SUMO_FOLDER, ignore_errors=True)
    with contextlib.suppress(OSError):
        (folder / "manifest.json").unlink()
        folder.rmdir()


def write_results(result: RunResult, folder: Path, *, parquet: bool = False) -> None:
    """Write everything but the pictures into ``folder``.

    Raises:
        ResultsError: the disk is full or the folder has become unwritable.
    """
    frames = {
        name: _rounded(result.summary_table if name == "summary" else getattr(result, name))
        for name in result.schemas
    }
    try:
        for name in FILES - {SUMO_FOLDER}:
            (folder / name).unlink(missing_ok=True)  # results are never mixed
        (folder / "config.toml").write_text(result.config_text, encoding="utf-8")
        for name in frames:
            frames[name].to_csv(folder / f"{name}.csv", index=False, lineterminator="\n")
            if parquet:
                _write_parquet(frames[name], folder / f"{name}.parquet")
        _write_json(folder / "summary.json", _summary(result))
        _write_json(folder / "manifest.json", result.manifest)
        _write_json(folder / "datapackage.json", data_package(result))
        (folder / SCENE_FILE).write_text(scene_of(result).to_json(), encoding="utf-8")
        if result.sumo_messages:
            (folder / "sumo.log").write_text(result.sumo_messages, encoding="utf-8")
    except OSError as error:
        raise ResultsError(
            f"{error.filename or folder}: cannot be written ({error.strerror}); free the disk"
        ) from error


def _summary(result: RunResult) -> dict[str, Any]:
    """The first ego's row, the other egos' rows, and the computing times."""
    rows = [_plain(row) for row in result.summary_table.to_dict("records")]
    more = {"egos": rows} if len(rows) > 1 else {}
    return result.summary | more | {"timing": result.timing_summary}


def _plain(row: dict[Any, Any]) -> dict[str, Any]:
    """The row in Python's own types, which JSON knows."""
    return {str(k): v.item() if isinstance(v, np.generic) else v for k, v in row.items()}


def rounded_row(row: dict[Any, Any]) -> dict[str, Any]:
    """One row of a table as it is written: Python's own types, floats to six decimals."""
    return {
        key: round(value, _DECIMALS) + 0.0 if isinstance(value, float) else value
        for key, value in _plain(row).items()
    }


def sumo_folder(folder: Path) -> Path:
    """The folder for SUMO's own outputs; those of a former run are removed.

    Raises:
        ResultsError: they cannot be removed.
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


def require_parquet() -> None:
    """Make sure that Parquet can be written before anything is computed.

    Raises:
        ResultsError: pyarrow is missing.
    """
    try:
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise ResultsError(
            "--parquet needs pyarrow; install it with: pip install 'giveway[parquet]'"
        ) from error


def data_package(result: RunResult) -> dict[str, Any]:
    """The Frictionless description of a run's CSV files."""
    name = f"giveway-{result.scenario.name}-{result.config.seed}"
    title = f"giveway run of {result.scenario.name}, seed {result.config.seed}"
    return package_of(name, title, result.schemas)


def package_of(name: str, title: str, schemas: Mapping[str, Sequence[Column]]) -> dict[str, Any]:
    """The Frictionless description of CSV files: each column's type, unit and meaning.

    Args:
        name: of the package.
        title: of the package, for readers.
        schemas: the columns of each file, by its name without the suffix.
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
    """The columns as the schema of a data package has them."""
    fields = []
    for column in columns:
        field = {"name": column.name, "type": column.type}
        if column.unit is not None:
            field["unit"] = column.unit
        fields.append(field | {"description": column.description})
    return fields


def _rounded(frame: pd.DataFrame) -> pd.DataFrame:
    """Floats to six decimals, without negative zeros: short, and the same bytes on every system."""
    frame = frame.copy()
    for name in frame.columns:
        if frame[name].dtype == np.float64:
            frame[name] = np.round(frame[name].to_numpy(), _DECIMALS) + 0.0
    return frame


def _write_parquet(frame: pd.DataFrame, path: Path) -> None:
    import pyarrow
    import pyarrow.parquet

    pyarrow.parquet.write_table(pyarrow.Table.from_pandas(frame, preserve_index=False), path)


def _write_json(path: Path, content: dict[str, Any]) -> None:
    text = json.dumps(_json_ready(content), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _json_ready(value: Any) -> Any:
    """The value for JSON, which has neither NaN nor infinity: they become null."""
    if isinstance(value, dict):
        return {key: _json_ready(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_json_ready(item) for item in value]
    if isinstance(value, float):
        return round(value, _DECIMALS) + 0.0 if math.isfinite(value) else None
    return value
