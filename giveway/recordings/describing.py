"""The description of recordings: who is in them, how near they come, and what is wrong."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.metrics.close_passes import NEAR
from giveway.recordings.drives import MOVING, drive_of, nearness
from giveway.recordings.recording import OVERLAP, Defect, Recording, Tracks
from giveway.run_data.columns import Quantity, columns_of

TOTAL = "total"


@dataclass(frozen=True)
class RecordingRow:
    """The row of a recording in ``recordings.csv``."""

    recording: Annotated[str, Quantity(None, "name of the recording, or total")]
    people: Annotated[int, Quantity("persons", "people on foot")]
    moving: Annotated[int, Quantity("vehicles", "vehicles that reach 1 m/s")]
    parked: Annotated[int, Quantity("vehicles", "vehicles that do not")]
    encounters: Annotated[
        int, Quantity(None, "pairs of a person and a moving vehicle within 4 m, outline to outline")
    ]
    duration: Annotated[float, Quantity("s", "from the first to the last instant")]
    walking_speed: Annotated[float, Quantity("m/s", "median over people of their mean speed")]
    walking_speed_95: Annotated[float, Quantity("m/s", "95 % of people are slower")]
    smallest_gap: Annotated[
        float, Quantity("m", "smallest clearance of a person and any vehicle; negative: overlap")
    ]
    defects: Annotated[int, Quantity(None, "number of defects, of all kinds")]


RECORDING_FIELDS = columns_of(RecordingRow)


@dataclass(frozen=True, eq=False)
class Described:
    """The description of the recordings of a data set.

    Attributes:
        table: Table with a row per recording, and the total last; columns ``RECORDING_FIELDS``.
        defects: Table of defects: recording, defect, count, example.
    """

    table: pd.DataFrame
    defects: pd.DataFrame


def describe(
    recordings: Sequence[Recording], advance: Callable[[str], None] = lambda _name: None
) -> Described:
    """Describe recordings: people, vehicles, encounters, speeds, gaps and defects.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.
        advance: Function that is called with the name of each recording that is described.
    """
    rows, speeds, faults = [], [], []
    for read in recordings:
        recording = read.walkers()
        row, defects, walking = _described(recording)
        rows.append(row)
        speeds.append(walking)
        faults += [(recording.name, d.kind, d.count, d.example) for d in defects]
        advance(recording.name)
    rows.append(_total(rows, np.concatenate([np.empty(0), *speeds])))
    names = [column.name for column in RECORDING_FIELDS]
    table = pd.DataFrame([asdict(row) for row in rows], columns=names)
    found = pd.DataFrame(faults, columns=["recording", "defect", "count", "example"])
    return Described(table, found)


def parked(vehicles: Tracks) -> NDArray[np.bool_]:
    """Return whether each vehicle (n,) never reaches ``MOVING``."""
    return vehicles.peak() < MOVING


def _described(recording: Recording) -> tuple[RecordingRow, list[Defect], Array]:
    """Return the row of a recording, its defects, and the mean speed (n,) [m/s] of each person."""
    people, vehicles = recording.people, recording.vehicles
    still = parked(vehicles)
    encounters, overlaps, smallest = 0, [], np.inf
    for number in range(len(vehicles.ids)):
        near = nearness(drive_of(recording, number))
        closest = near.smallest(near.clearance, len(people.ids))
        encounters += 0 if still[number] else int((closest <= NEAR).sum())
        smallest = min(smallest, float(closest.min(initial=np.inf)))
        overlaps += [
            (float(closest[who]), people.ids[who], vehicles.ids[number])
            for who in np.flatnonzero(closest < 0.0).tolist()
        ]
    defects = list(recording.defects)
    if overlaps:
        depth, who, vehicle = min(overlaps)
        example = f"{who} is {-depth:.2f} m inside vehicle {vehicle}"
        defects.append(Defect(OVERLAP, len(overlaps), example))
    total = np.bincount(people.track, people.speed, minlength=len(people.ids))
    walking = total / np.maximum(np.bincount(people.track, minlength=len(people.ids)), 1)
    row = RecordingRow(
        recording=recording.name,
        people=len(people.ids),
        moving=int((~still).sum()),
        parked=int(still.sum()),
        encounters=encounters,
        duration=recording.duration,
        walking_speed=_quantile(walking, 0.5),
        walking_speed_95=_quantile(walking, 0.95),
        smallest_gap=smallest if np.isfinite(smallest) else np.nan,
        defects=sum(defect.count for defect in defects),
    )
    return row, defects, walking


def _quantile(values: Array, share: float) -> float:
    return float(np.quantile(values, share)) if len(values) else np.nan


def _total(rows: Sequence[RecordingRow], walking: Array) -> RecordingRow:
    gaps = [row.smallest_gap for row in rows if np.isfinite(row.smallest_gap)]
    return RecordingRow(
        recording=TOTAL,
        people=sum(row.people for row in rows),
        moving=sum(row.moving for row in rows),
        parked=sum(row.parked for row in rows),
        encounters=sum(row.encounters for row in rows),
        duration=sum(row.duration for row in rows),
        walking_speed=_quantile(walking, 0.5),
        walking_speed_95=_quantile(walking, 0.95),
        smallest_gap=min(gaps, default=np.nan),
        defects=sum(row.defects for row in rows),
    )
