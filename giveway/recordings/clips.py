"""The recording that ``[[crowd.recorded]]`` names: its files, and its tracks, read once."""

from collections import OrderedDict
from pathlib import Path

from giveway.config.tables.recorded import RecordedConfig
from giveway.errors import ConfigError, DatasetError, suggestion
from giveway.recordings.dataset import Dataset, dataset_of
from giveway.recordings.reading import RecordingFiles, files_in, read_files
from giveway.recordings.recording import Recording

_KEPT = 8  # Number of recordings that a process remembers
_read: OrderedDict[tuple[object, ...], Recording] = OrderedDict()


def read_clip(entry: RecordedConfig) -> Recording:
    """Return the recording of an entry, without riders among its people.

    Args:
        entry: Entry of the configuration.

    Raises:
        ConfigError: the data set or the clip is unknown, or there is nobody in the recording.
        DatasetError: there is no such file or folder, or a file cannot be used.
    """
    return clip_at(Path(entry.path), entry.dataset, entry.clip, _heading(entry))


def clip_at(path: Path, dataset_name: str | None, clip: str, heading: str) -> Recording:
    """Return a recording, without riders among its people.

    Args:
        path: Folder of recordings, or a file of the recording.
        dataset_name: Name or description of the data set, or None if it is not given.
        clip: Name of the recording, or an empty text if it is the only one.
        heading: Words with which messages begin.

    Raises:
        ConfigError: the data set or the clip is unknown, or there is nobody in the recording.
        DatasetError: there is no such file or folder, or a file cannot be used.
    """
    files, dataset = _found(path, dataset_name, clip, heading)
    stamps = [(str(file), file.stat().st_mtime_ns, file.stat().st_size) for file in _all(files)]
    key = (dataset.model_dump_json(), *stamps)
    if key not in _read:
        try:
            _read[key] = read_files(files, dataset).walkers()
        except DatasetError as error:
            raise DatasetError(f"{heading}: {error}") from error
        if len(_read) > _KEPT:
            _read.popitem(last=False)
    recording = _read[key]
    if not recording.people.ids:
        raise ConfigError(
            f"{heading}: {recording.file}: clip '{recording.name}' of {dataset.name} has "
            "no people on foot; name a clip that has (giveway data describe)"
        )
    return recording


def clip_files(entry: RecordedConfig) -> tuple[Path, ...]:
    """Return all files that an entry is read from, the data set's own description among them.

    Raises:
        ConfigError: the data set or the clip is unknown.
        DatasetError: there is no such file or folder.
    """
    files, _ = _found(Path(entry.path), entry.dataset, entry.clip, _heading(entry))
    own = Path(entry.dataset)
    return (*_all(files), own) if own.suffix == ".toml" else tuple(_all(files))


def _found(
    path: Path, dataset_name: str | None, clip: str, heading: str
) -> tuple[RecordingFiles, Dataset]:
    """Return the files of the clip that is named, or of the only one that is there."""
    dataset = dataset_of(dataset_name, f"{heading}: dataset")
    if not path.exists():
        raise DatasetError(
            f"{heading}: path = '{path}': no such file or folder; expected a recording, or "
            "a folder of recordings"
        )
    try:
        clips = files_in(path if path.is_dir() else path.parent, dataset)
    except DatasetError as error:
        raise DatasetError(f"{heading}: {error}") from error
    if not path.is_dir():
        clips = [each for each in clips if path in {file for file, _, _ in each.tables}]
        if not clips:
            raise DatasetError(
                f"{heading}: path = '{path}': no file of tracks of {dataset.name}; expected"
                f" {', '.join(table.files for table in dataset.layout)}"
            )
    names = [each.name for each in clips]
    if clip and clip not in names:
        raise ConfigError(f"{heading}: clip = '{clip}': not in {path}; {suggestion(clip, names)}")
    wanted = [each for each in clips if clip in {"", each.name}]
    if len(wanted) > 1:
        raise ConfigError(
            f"{heading}: {path} has {len(wanted)} recordings; name one as clip: "
            f"{', '.join(names[:5])}{', ...' if len(names) > 5 else ''}"
        )
    return wanted[0], dataset


def _all(files: RecordingFiles) -> list[Path]:
    """Return the files of tracks, and those beside them with labels and the frame rate."""
    joined = [table.join.files for _, table, _ in files.tables if table.join is not None]
    beside = [files.root / name.replace("{name}", files.name) for name in joined]
    return [*(file for file, _, _ in files.tables), *(file for file in beside if file.is_file())]


def _heading(entry: RecordedConfig) -> str:
    return f"[[crowd.recorded]] '{entry.name}'"
