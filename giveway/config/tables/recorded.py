"""``[[crowd.recorded]]``: recordings whose people come into a run, and the model ``recorded``."""

from __future__ import annotations

from typing import Any, Final, Literal

from giveway.config.option import Name, Section, option, read_tables, reader_of_named
from giveway.config.tables.people import ADULT, Kind

RECORDED: Final = "recorded"
"""Name of the model that moves people as they were recorded."""
_FARTHEST = 1e7  # Largest coordinate [m]; beyond it a millimetre is lost in rounding
_LONGEST = 1e5  # Longest time [s] between the beginnings of a recording and a run
_MOST = 20  # Largest number of recordings in a run


class RecordedOptions(Section):
    """Options of the model ``recorded``, in [model_options]; docs/recordings.md."""

    then: Literal["vci", "social-force", "gap-acceptance", "constant-velocity", "orca"] = option(
        "vci", None, "model that moves a person after the hand-over, and people of other origin"
    )
    time: float = option(
        2.0, "s", "a person is handed over if a vehicle could be there so soon", ge=0, le=60
    )
    distance: float = option(
        4.0, "m", "a person is handed over if a vehicle's outline is so near", ge=0, le=200
    )


class RecordedConfig(Section):
    """One recording whose people come into the run."""

    name: Name = option(
        "",
        None,
        "Name of the entry, of letters and digits. Its people are called name.ID by their ids in "
        "the files",
        pattern=r"^[A-Za-z0-9_.-]{1,60}$",
    )
    path: str = option(..., None, "Folder of the recording, or one of its files", min_length=1)
    dataset: str = option(
        ...,
        None,
        "Data set that describes the files: one that giveway knows, or a description (TOML)",
        min_length=1,
    )
    clip: str = option(
        "", None, "Name of the recording. It may be left out if there is no other in the folder"
    )
    begin: float = option(
        0.0,
        "s",
        "Time after the run's start at which the recording begins. Of a recording that began "
        "before it, < 0, people are on their way already",
        ge=-_LONGEST,
        le=_LONGEST,
        because="no recording lasts longer",
    )
    x: float = option(
        0.0, "m", "Place x of the recording's origin in the network", ge=-_FARTHEST, le=_FARTHEST
    )
    y: float = option(0.0, "m", "Place y of the same point", ge=-_FARTHEST, le=_FARTHEST)
    heading: float = option(
        0.0,
        "deg",
        "Angle by which the recording is turned about its origin, counter-clockwise",
        ge=-360,
        le=360,
    )
    walk_on: float = option(
        0.0,
        "m",
        "Distance that people go on beyond the end of their tracks, in the last direction, moved "
        "by a model",
        ge=0,
        le=1000,
        because="nothing is known of people so far from where they were seen",
    )
    kind: Kind = option(
        ADULT,
        None,
        "Kind of its people, as in [crowd.people]. Children are smaller, for sensors",
    )
    judged: bool = option(
        False,
        None,
        "Contacts with its people count as those with others do, though they walk as recorded: "
        "they are the dummies of a test",
    )
    vehicle: str = option(
        "",
        None,
        "Id of the recorded vehicle in whose place the ego drives; giveway data compare needs it",
    )

    def settings(self) -> dict[str, Any]:
        """Return the entries for a table of a TOML file."""
        values: dict[str, Any] = self.model_dump(mode="json", exclude_defaults=True)
        return values


def read_recorded(value: Any) -> tuple[RecordedConfig, ...]:
    """Read the recordings in a TOML file or a dictionary.

    Raises:
        ValueError: an entry is not valid; the message names it.
    """
    if isinstance(value, list | tuple) and len(value) > _MOST:
        raise ValueError(f"{len(value)} recordings: expected {_MOST} at most")
    return read_tables(
        value,
        RecordedConfig,
        RECORDED,
        "[[crowd.recorded]]",
        reader_of_named(RecordedConfig, RECORDED),
    )
