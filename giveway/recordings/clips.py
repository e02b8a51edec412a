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
    files, dataset = _found(entry)
    stamps = [(str(file), file.stat().st_mtime_ns, file.stat().st_size) for file in _all(files)]
    key = (dataset.model_dump_json(), *stamps)
    if key not in _read:
        try:
            _read[key] = read_files(files, dataset).walkers()
        except DatasetError as error:
            raise _about(entry, error) from error
        if len(_read) > _KEPT:
            _read.popitem(last=False)
    recording = _read[key]
    if not recording.people.ids:
        raise ConfigError(
            f"{_heading(entry)}: {recording.file}: clip '{recording.name}' of {dataset.name} has "
            "no people on foot; name a clip that has (giveway data describe)"
        )
    return recording


def clip_files(entry: RecordedConfig) -> tuple[Path, ...]:
    """Return all files that an entry is read from, the data set's own description among them.

    Raises:
        ConfigError: the data set or the clip is unknown.
        DatasetError: there is no such file or folder.
    """
    files, _ = _found(entry)
    own = Path(entry.dataset)
    return (*_all(files), own) if own.suffix == ".toml" else tuple(_all(files))


def _found(entry: RecordedConfig) -> tuple[RecordingFiles, Dataset]:
    """Return the files of the clip that is named, or of the only one that is there."""
    dataset = dataset_of(entry.dataset, f"{_heading(entry)}: dataset")
    path = Path(entry.path)
    if not path.exists():
        raise DatasetError(
            f"{_heading(entry)}: path = '{path}': no such file or folder; expected a recording, or "
            "a folder of recordings"
        )
    try:
        clips = files_in(path if path.is_dir() else path.parent, dataset)
    except DatasetError as error:
        raise _about(entry, error) from error
    if not path.is_dir():
        clips = [clip for clip in clips if path in {file for file, _, _ in clip.tables}]
        if not clips:
            raise DatasetError(
                f"{_heading(entry)}: path = '{path}': no file of tracks of {dataset.name}; expected"
                f" {', '.join(table.files for table in dataset.layout)}"
            )
    names = [clip.name for clip in clips]
    if entry.clip and entry.clip not in names:
        raise ConfigError(
            f"{_heading(entry)}: clip = '{entry.clip}': not in {path}; "
            f"{suggestion(entry.clip, names)}"
        )
    wanted = [clip for clip in clips if entry.clip in {"", clip.name}]
    if len(wanted) > 1:
        raise ConfigError(
            f"{_heading(entry)}: {path} has {len(wanted)} recordings; name one as clip: "
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


def _about(entry: RecordedConfig, error: DatasetError) -> DatasetError:
    return DatasetError(f"{_heading(entry)}: {error}")
