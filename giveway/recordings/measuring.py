"""The measures of recorded drives: giveway's own, without a run."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np
import pandas as pd

from controller.driving_constants import STANDING
from giveway.errors import DatasetError, suggestion
from giveway.metrics.close_passes import (
    CLOSE,
    CLOSE_SPEED,
    NEAR,
    TIGHT,
    TIGHT_SPEED,
    Passes,
    passes,
)
from giveway.metrics.conflicts import CRITICAL_TTC
from giveway.metrics.encroachment import EGO, PERSON
from giveway.recordings.describing import parked
from giveway.recordings.drives import Drive, drive_of, encroachments, nearness
from giveway.recordings.intervals import ClipBootstrap
from giveway.recordings.recording import Recording
from giveway.run_data.columns import Quantity, columns_of
from giveway.run_data.tracks import EgoTrack

SHORT_PET = 1.0
"""Post-encroachment time [s] below which it is short."""
VEHICLE = "vehicle"
"""Word of the column ``first`` if the vehicle was first."""
_SHORTEST = 20  # Number of instants of a drive that is long enough to be measured
SEED = 0
"""Seed of the bootstrap's draws."""


@dataclass(frozen=True)
class DriveRow:
    """The row of a recorded vehicle in ``vehicles.csv``."""

    recording: Annotated[str, Quantity(None, "name of the recording")]
    vehicle: Annotated[str, Quantity(None, "id of the vehicle")]
    duration: Annotated[float, Quantity("s", "from its first to its last instant")]
    mean_speed: Annotated[float, Quantity("m/s", "mean over its instants")]
    maximum_speed: Annotated[float, Quantity("m/s", "largest speed")]
    standing: Annotated[float, Quantity(None, "share of its instants below 0.2 m/s")]
    rms_jerk: Annotated[float, Quantity("m/s^3", "root mean square of the jerk, by differences")]
    peak_deceleration: Annotated[float, Quantity("m/s^2", "hardest braking, by differences")]
    near: Annotated[int, Quantity("persons", "people within 4 m of it, outline to outline")]
    near_moving: Annotated[
        int, Quantity("persons", "people within 4 m while it was faster than 0.5 m/s")
    ]
    close: Annotated[int, Quantity("persons", "people closer than 0.5 m at more than 2 m/s")]
    tight: Annotated[int, Quantity("persons", "people closer than 0.3 m at more than 3 m/s")]


@dataclass(frozen=True)
class PersonRow:
    """The row of a person near a recorded vehicle in ``people.csv``."""

    recording: Annotated[str, Quantity(None, "name of the recording")]
    vehicle: Annotated[str, Quantity(None, "id of the vehicle")]
    person: Annotated[str, Quantity(None, "id of the person")]
    clearance: Annotated[
        float, Quantity("m", "smallest clearance at one instant; negative: overlap")
    ]
    clearance_moving: Annotated[
        float, Quantity("m", "smallest clearance at more than 0.5 m/s; empty: never as fast")
    ]
    clearance_above_2: Annotated[
        float, Quantity("m", "smallest clearance at more than 2 m/s; empty: never as fast")
    ]
    clearance_above_3: Annotated[
        float, Quantity("m", "smallest clearance at more than 3 m/s; empty: never as fast")
    ]
    time_to_collision: Annotated[
        float, Quantity("s", "smallest time to collision with the moving vehicle; empty: none")
    ]
    post_encroachment_time: Annotated[
        float,
        Quantity("s", "post-encroachment time; negative: the vehicle was first; empty: none"),
    ]
    first: Annotated[str, Quantity(None, "who was first: person, vehicle or contact; or empty")]


@dataclass(frozen=True)
class Share:
    """The share of people near a vehicle of whom something holds.

    Attributes:
        name: What holds.
        count: Number of people.
        share: Share of all people near a vehicle; nan without any.
        low, high: 95 % interval, whole vehicles resampled; nan with fewer than two vehicles.
        share_moving: Share of the people near a vehicle that moves, of whom it holds.
        low_moving, high_moving: Its interval.
    """

    name: str
    count: int
    share: float
    low: float
    high: float
    share_moving: float
    low_moving: float
    high_moving: float


DRIVE_FIELDS = columns_of(DriveRow)
PERSON_FIELDS = columns_of(PersonRow)
SHARES = (
    f"closer than {CLOSE:g} m at more than {CLOSE_SPEED:g} m/s",
    f"closer than {TIGHT:g} m at more than {TIGHT_SPEED:g} m/s",
    f"time to collision below {CRITICAL_TTC:g} s",
    f"post-encroachment time below {SHORT_PET:g} s",
    f"post-encroachment time below {SHORT_PET:g} s, the person first",
)
"""Names of the shares of the summary, in order: close passes first."""


@dataclass(frozen=True, eq=False)
class Measured:
    """The measures of recorded drives.

    Attributes:
        drives: Table with a row per vehicle; columns ``DRIVE_FIELDS``.
        people: Table with a row per person near a vehicle; columns ``PERSON_FIELDS``.
        shares: Shares ``SHARES`` of the people near, over all drives.
    """

    drives: pd.DataFrame
    people: pd.DataFrame
    shares: tuple[Share, ...]

    @property
    def summary(self) -> pd.DataFrame:
        """The shares as a table."""
        return pd.DataFrame([asdict(share) for share in self.shares])


def measure(
    recordings: Sequence[Recording],
    vehicle: str | None = None,
    advance: Callable[[str], None] = lambda _name: None,
) -> Measured:
    """Measure recorded drives: how they drive, and how they pass the people near them.

    Parked vehicles, and those seen for fewer than 20 instants, are no drives.

    Args:
        recordings: Recordings from :func:`giveway.recordings.read_recordings`.
        vehicle: Id of the only vehicle that is measured, or None for all.
        advance: Function that is called with the name of each recording that is measured.

    Raises:
        DatasetError: there is no drive, or none with this id.
    """
    drives: list[DriveRow] = []
    people: list[PersonRow] = []
    for read in recordings:
        recording = read.walkers()
        for number in _driven(recording, vehicle):
            drive, passed = _measured(drive_of(recording, number))
            drives.append(drive)
            people += passed
        advance(recording.name)
    if not drives:
        raise DatasetError(_nothing(recordings, vehicle))
    table, passes = _table(drives, DRIVE_FIELDS), _table(people, PERSON_FIELDS)
    return Measured(table, passes, _shares(table, passes))


def _driven(recording: Recording, vehicle: str | None) -> list[int]:
    """Return the vehicles of a recording that drive and are asked for."""
    vehicles = recording.vehicles
    long = np.diff(vehicles.bounds) >= _SHORTEST
    asked = np.array([vehicle in {None, each} for each in vehicles.ids], dtype=bool)
    return np.flatnonzero(long & ~parked(vehicles) & asked).tolist()


def _nothing(recordings: Sequence[Recording], vehicle: str | None) -> str:
    ids = list(dict.fromkeys(each for read in recordings for each in read.vehicles.ids))
    if vehicle is None or vehicle in ids:
        which = "the recordings" if vehicle is None else f"--vehicle {vehicle}"
        return (
            f"{which}: no drive; expected a vehicle that is seen for {_SHORTEST} instants and "
            "reaches 1 m/s; giveway data describe counts those that there are"
        )
    return f"--vehicle {vehicle}: no such id; {suggestion(vehicle, ids)}"


def _measured(drive: Drive) -> tuple[DriveRow, list[PersonRow]]:
    """Return the rows of a drive, and of the people near it."""
    track, ids = drive.track, drive.recording.people.ids
    found = nearness(drive)
    count = len(ids)
    clearance = found.clearances(count)
    moving = np.where(found.speed > STANDING, found.time_to_collision, np.inf)
    collision = found.smallest(moving, count)
    collision[np.isinf(collision)] = np.nan
    passed = passes(clearance)
    near = passed.near
    time, first = encroachments(drive, near)
    signed = np.where(first == PERSON, time, -time)
    people = [
        PersonRow(
            recording=drive.recording.name,
            vehicle=drive.id,
            person=ids[who],
            clearance=float(clearance.least[who]),
            clearance_moving=float(clearance.moving[who]),
            clearance_above_2=float(clearance.above_2[who]),
            clearance_above_3=float(clearance.above_3[who]),
            time_to_collision=float(collision[who]),
            post_encroachment_time=float(signed[who]) + 0.0,
            first=VEHICLE if first[who] == EGO else str(first[who]),
        )
        for who in np.flatnonzero(near).tolist()
    ]
    return _drive_row(drive, track, passed), people


def _drive_row(drive: Drive, track: EgoTrack, passed: Passes) -> DriveRow:
    jerk = np.gradient(track.acceleration, track.time)
    return DriveRow(
        recording=drive.recording.name,
        vehicle=drive.id,
        duration=float(track.time[-1] - track.time[0]),
        mean_speed=float(track.speed.mean()),
        maximum_speed=float(track.speed.max()),
        standing=float((track.speed < STANDING).mean()),
        rms_jerk=float(np.sqrt(np.mean(jerk**2))),
        peak_deceleration=max(0.0, -float(track.acceleration.min())),
        near=int(passed.near.sum()),
        near_moving=int(passed.near_moving.sum()),
        close=int(passed.close.sum()),
        tight=int(passed.tight.sum()),
    )


def _table(rows: Sequence[Any], fields: Sequence[Any]) -> pd.DataFrame:
    return pd.DataFrame([asdict(row) for row in rows], columns=[field.name for field in fields])


def _shares(drives: pd.DataFrame, people: pd.DataFrame) -> tuple[Share, ...]:
    """Return the shares of the people near, with intervals over vehicles."""
    time = people["post_encroachment_time"].to_numpy(dtype=np.float64)
    short = np.abs(time) < SHORT_PET
    held = (
        people["clearance_above_2"].to_numpy(dtype=np.float64) < CLOSE,
        people["clearance_above_3"].to_numpy(dtype=np.float64) < TIGHT,
        people["time_to_collision"].to_numpy(dtype=np.float64) < CRITICAL_TTC,
        short,
        short & (people["first"] == PERSON).to_numpy(dtype=bool),
    )
    keys = list(zip(drives["recording"], drives["vehicle"], strict=True))
    places = {key: place for place, key in enumerate(keys)}
    of = [places[key] for key in zip(people["recording"], people["vehicle"], strict=True)]
    drive = np.array(of, dtype=np.int64)
    draws = ClipBootstrap.of(len(keys), SEED)
    everybody = np.ones(len(people), dtype=bool)
    moving = people["clearance_moving"].to_numpy(dtype=np.float64) <= NEAR
    shares = []
    for name, mask in zip(SHARES, held, strict=True):
        parts = []
        for among in (everybody, moving):
            count = np.bincount(drive, among, len(keys)).astype(np.float64)
            total = np.bincount(drive, mask & among, len(keys)).astype(np.float64)
            part = float(mask[among].mean()) if among.any() else np.nan
            parts += [part, *draws.interval(total, count)]
        shares.append(Share(name, int(mask.sum()), *parts))
    return tuple(shares)
