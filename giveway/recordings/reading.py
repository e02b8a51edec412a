"""The reader of recordings: a folder and the description of a data set become tracks."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from giveway.errors import DatasetError
from giveway.recordings.conversion import tracks_of
from giveway.recordings.dataset import Dataset, TrackTable
from giveway.recordings.lights import light_defects
from giveway.recordings.recording import (
    DUPLICATE,
    EMPTY_TIME,
    LABEL,
    Defect,
    Recording,
)
from giveway.recordings.tables import LINES_BEFORE, read_csv, read_table, require_good

Progress = Callable[[int, int, str], None]  # numbers of recordings read and of all, name

_PLACEHOLDER = re.compile(r"\\\{(name|track)\\\}|\\\*")
_LAST_FRAME = 1e15  # Largest number of a frame; whole numbers are exact up to here
_EMPTY = ("id", "frame", "x", "y")


@dataclass(frozen=True)
class RecordingFiles:
    """The files of one recording: each with its table, and the track that its name gives."""

    root: Path
    name: str
    tables: list[tuple[Path, TrackTable, str]]


def read_recordings(
    folder: Path, dataset: Dataset, progress: Progress = lambda _done, _all, _name: None
) -> tuple[Recording, ...]:
    """Read all recordings in a folder or below it, in the order of their paths.

    Args:
        folder: Folder of the data set, or any part of it.
        dataset: Description of the data set.
        progress: Function of the number of recordings read, of all, and the name of the last.

    Raises:
        DatasetError: there is no such folder, no recording in it, or a file cannot be used.
    """
    if not folder.is_dir():
        raise DatasetError(f"{folder}: no such folder; expected a data set or a part of it")
    groups = files_in(folder, dataset)
    recordings = []
    for number, files in enumerate(groups, 1):
        recordings.append(read_files(files, dataset))
        progress(number, len(groups), files.name)
    return tuple(recordings)


def read_recording(file: Path, dataset: Dataset) -> Recording:
    """Read the recording to which a file of tracks belongs.

    Raises:
        DatasetError: a file cannot be used, or the description knows no file of this name.
    """
    for files in files_in(file.parent, dataset):
        if any(path == file for path, _, _ in files.tables):
            return read_files(files, dataset)
    raise DatasetError(f"{file}: no such file of tracks; expected {_patterns(dataset)}")


def _patterns(dataset: Dataset) -> str:
    return ", ".join(table.files.replace("{name}", "*") for table in dataset.layout)


def files_in(folder: Path, dataset: Dataset) -> list[RecordingFiles]:
    """Return the files of each recording, in the order of paths.

    Raises:
        DatasetError: there is no recording.
    """
    found: dict[tuple[Path, str], RecordingFiles] = {}
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    for table in dataset.layout:
        pattern = _pattern(table.files)
        for path in paths:
            match = pattern.fullmatch(f"/{path.relative_to(folder).as_posix()}")
            if match is None:
                continue
            named = match.groupdict()
            root = folder / match["root"].strip("/")
            name = named.get("name") or root.resolve().name
            files = found.setdefault((root, name), RecordingFiles(root, name, []))
            files.tables.append((path, table, named.get("track") or ""))
    if not found:
        raise DatasetError(
            f"{folder}: no recording found; expected files {_patterns(dataset)} in it or its "
            "folders; name the folder of the data set, or another --dataset"
        )
    return sorted(found.values(), key=lambda files: files.tables[0][0])


def _pattern(files: str) -> re.Pattern[str]:
    """Return the expression of a pattern with ``{name}``, ``{track}`` and ``*``."""

    def expression(match: re.Match[str]) -> str:
        return f"(?P<{match[1]}>[^/]+)" if match[1] else "[^/]*"

    return re.compile(f"(?P<root>(?:/[^/]+)*?)/{_PLACEHOLDER.sub(expression, re.escape(files))}")


def read_files(files: RecordingFiles, dataset: Dataset) -> Recording:
    """Return one recording.

    Raises:
        DatasetError: a file cannot be used.
    """
    defects: list[Defect] = []
    rate = _rate(files, dataset)
    rows: dict[str, list[pd.DataFrame]] = {"people": [], "vehicles": []}
    tables = [read_table(path, table) for path, table, _ in files.tables]
    unit = _time_unit(tables, rate)
    for (path, table, track), read in zip(files.tables, tables, strict=True):
        if "id" not in read:
            read["id"] = track
        if "frame" not in read:
            read["frame"] = _frames(path, table, read["time"], unit, rate)
        defects += _time_defects(path, table)
        for role, part in _by_role(files, table, dataset, read, defects):
            rows[role].append(_without_duplicates(path, table, part, defects))
    whole = {role: _joined(parts) for role, parts in rows.items()}
    frames = pd.concat([table["frame"] for table in whole.values()]).to_numpy(dtype=np.int64)
    if not len(frames):
        raise DatasetError(
            f"{files.tables[0][0]}: neither people nor vehicles; expected labels "
            f"{', '.join((*dataset.people, *dataset.vehicles))}; correct the description"
        )
    # a file of people names the frames; vehicles may be seen before them
    first, stride = int(frames.min()), _stride(whole, rate)
    last = int(frames.max())
    people = tracks_of(whole["people"], "people", dataset, first, stride, rate, defects)
    vehicles = tracks_of(whole["vehicles"], "vehicles", dataset, first, stride, rate, defects)
    defects += light_defects(files.root, dataset.lights)
    return Recording(
        name=files.name,
        file=files.tables[0][0],
        dataset=dataset,
        frame_rate=rate / stride,
        first_frame=first,
        frames=(last - first) // stride + 1,
        people=people,
        vehicles=vehicles,
        defects=_counted(defects),
    )


def _rate(files: RecordingFiles, dataset: Dataset) -> float:
    """Return the frame rate [1/s] by the recording's own file, or by the description.

    Raises:
        DatasetError: the file cannot be used.
    """
    if dataset.rate_file is None:
        return dataset.frame_rate
    file = files.root / dataset.rate_file.files.replace("{name}", files.name)
    if not file.is_file():
        return dataset.frame_rate
    table = read_csv(file)
    column = dataset.rate_file.column
    value = table[column].iloc[0] if column in table and len(table) else "nothing"
    try:
        rate = float(value)
    except ValueError:
        rate = np.nan
    if not 0.5 <= rate <= 1000.0:
        raise DatasetError(
            f"{file}: {column} = {value!r}: expected a frame rate from 0.5 to 1000 1/s; take the "
            "file from the dataset again"
        )
    return rate


def _time_unit(tables: Sequence[pd.DataFrame], rate: float) -> float:
    """Return how many units of the files' times are a second: a power of ten.

    It is the one by which rows are nearest to one frame apart.
    """
    steps = [np.diff(np.unique(table["time"])) for table in tables if "time" in table]
    step = np.concatenate([np.empty(0), *steps])
    apart = float(np.median(step)) if len(step) else 1.0 / rate
    return float(10.0 ** np.round(np.log10(apart * rate)))


def _frames(
    path: Path, table: TrackTable, time: "pd.Series[float]", unit: float, rate: float
) -> "pd.Series[int]":
    """Return the number of the frame at each time; a second has ``unit`` of the file's units."""
    frame = (time / unit * rate).round()
    bad = ~(frame.abs() <= _LAST_FRAME).to_numpy()
    head = LINES_BEFORE.get(table.format)
    require_good(path, time, str(table.columns.time), head, bad, "a time within the recording")
    return frame.astype(np.int64)


def _time_defects(path: Path, table: TrackTable) -> list[Defect]:
    """Return how many times beside frames are empty or negative."""
    if not (table.columns.frame and table.columns.time and table.format == "csv"):
        return []
    time = pd.to_numeric(read_csv(path)[table.columns.time], errors="coerce").to_numpy()
    bad = ~(time >= 0.0)
    return [Defect(EMPTY_TIME, int(bad.sum()), f"{path.name}: frames count")] if bad.any() else []


def _by_role(
    files: RecordingFiles,
    table: TrackTable,
    dataset: Dataset,
    rows: pd.DataFrame,
    defects: list[Defect],
) -> list[tuple[str, pd.DataFrame]]:
    """Return the rows of people and of vehicles by their labels.

    Raises:
        DatasetError: a file with the labels cannot be used.
    """
    if table.join is not None:
        rows = rows.assign(kind=_labels(files, table, rows))
    if "kind" not in rows:
        return [(table.holds, rows)]
    label = rows["kind"].str.lower()
    parts = []
    known = np.zeros(len(rows), dtype=bool)
    for role, labels in (("people", dataset.people), ("vehicles", dataset.vehicles)):
        if table.holds not in {role, "both"}:
            continue
        mine = label.isin(labels).to_numpy() if labels else ~known
        known |= mine
        if mine.any():
            parts.append((role, rows[mine]))
    for other, theirs in rows[~known].groupby("kind"):
        defects.append(Defect(LABEL, theirs["id"].nunique(), f"'{other}', left out"))
    return parts


def _labels(files: RecordingFiles, table: TrackTable, rows: pd.DataFrame) -> "pd.Series[str]":
    """Return the label of each row's track by the file that has one row per track.

    Raises:
        DatasetError: the file is not there, lacks a column, or does not know a track.
    """
    join = table.join
    assert join is not None
    file = files.root / join.files.replace("{name}", files.name)
    if not file.is_file():
        raise DatasetError(f"{file}: no such file; expected the labels of {files.name}'s tracks")
    beside = read_csv(file)
    missing = [name for name in (join.id, join.kind) if name not in beside]
    if missing:
        raise DatasetError(
            f"{file}: column '{missing[0]}' is missing; expected {join.id},{join.kind}"
        )
    found = rows["id"].map(dict(zip(beside[join.id].str.strip(), beside[join.kind], strict=True)))
    if found.isna().any():
        who = rows["id"][found.isna()].iloc[0]
        raise DatasetError(f"{file}: {join.id} {who} is missing; expected a row for each track")
    return found.str.strip()


def _without_duplicates(
    path: Path, table: TrackTable, rows: pd.DataFrame, defects: list[Defect]
) -> pd.DataFrame:
    twice = rows.duplicated(["id", "frame"])
    if twice.any():
        row = int(twice.to_numpy().argmax())
        line = int(rows.index[row]) + (1 if table.format == "text" else 2)
        who, frame = rows["id"].iloc[row], int(rows["frame"].iloc[row])
        example = f"{path}: line {line}: id {who} is in frame {frame} twice"
        defects.append(Defect(DUPLICATE, int(twice.sum()), example))
    return rows[~twice]


def _joined(parts: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return the rows of all files in the order of ids and frames; numbers before words."""
    if not parts:
        return pd.DataFrame({name: pd.Series(dtype=float) for name in _EMPTY})
    rows = pd.concat(parts, ignore_index=True)
    number = pd.to_numeric(rows["id"], errors="coerce")
    whole = (number == np.floor(number)).all() and (number.abs() < 2.0**63).all()
    if whole:
        rows["id"] = number.astype(np.int64)
    rows = rows.sort_values(["id", "frame"], kind="stable", ignore_index=True)
    rows["id"] = rows["id"].astype(str)
    return rows


def _stride(whole: dict[str, pd.DataFrame], rate: float) -> int:
    """Return the frames from row to row of most tracks: 1 where every frame has places."""
    steps = [
        np.diff(table["frame"])[(table["id"].to_numpy()[1:] == table["id"].to_numpy()[:-1])]
        for table in whole.values()
        if len(table)
    ]
    step = np.concatenate([np.empty(0), *steps])
    step = step[(step > 0) & (step <= 2.0 * rate)]
    return int(np.median(step)) if len(step) else 1


def _counted(defects: Sequence[Defect]) -> tuple[Defect, ...]:
    """Return one defect of each kind, with the sum of the counts and the first example."""
    merged: dict[str, Defect] = {}
    for defect in defects:
        before = merged.get(defect.kind)
        count = defect.count + (before.count if before else 0)
        merged[defect.kind] = Defect(defect.kind, count, (before or defect).example)
    return tuple(merged.values())
