"""Drives of egos beside those of the recorded vehicles in whose place they drove."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.config.tables.recorded import RecordedConfig
from giveway.errors import ConfigError, suggestion
from giveway.geometry.bodies import BODY
from giveway.geometry.path import directions
from giveway.metrics.conflicts import CRITICAL_TTC
from giveway.metrics.contacts import FRONTAL, SIDE
from giveway.metrics.contacts import RECORDED as UNAWARE
from giveway.metrics.encroachment import PERSON
from giveway.recordings import Dataset, Recording, Tracks, dataset_of
from giveway.recordings.clips import read_clip
from giveway.recordings.measuring import SHORT_PET, VEHICLE, measure
from giveway.replays.run_folder import RunFolder

MEASURES = (
    ("duration", "time [s]"),
    ("mean_speed", "mean speed [m/s]"),
    ("maximum_speed", "top speed [m/s]"),
    ("standing", "time below 0.2 m/s"),
    ("rms_jerk", "RMS jerk [m/s3]"),
    ("peak_deceleration", "braking [m/s2]"),
    ("near", "people within 4 m"),
    ("clearance", "least clearance [m]"),
    ("clearance_above_2", "above 2 m/s [m]"),
    ("close", "< 0.5 m at > 2 m/s"),
    ("short_ttc", f"TTC below {CRITICAL_TTC:g} s"),
    ("short_pet", f"PET below {SHORT_PET:g} s"),
    ("person_first", "the person went first"),
    ("vehicle_first", "the vehicle went first"),
    ("touched", "people touched"),
    ("unaware", "while they did not react"),
)
"""The rows of the comparison: name of the measure, and its words."""
RECORDED_DRIVER = "recorded driver"


def compared(folders: Sequence[Path], *, unsealed: bool = False) -> pd.DataFrame:
    """Return the measures of recorded drivers and of runs, a row for each driver.

    The columns are driver, recording, vehicle, and the names of ``MEASURES``. All are measured with
    the same definitions, between the vehicle's first and last instant.

    Args:
        folders: Results folders of runs.
        unsealed: True to read tables that differ from those that a run wrote.

    Raises:
        ConfigError: a run has no recorded people, or its recording names no vehicle.
        GivewayError: a folder or its recording cannot be read, or somebody did not drive.
    """
    rows: dict[tuple[str, ...], dict[str, object]] = {}
    for folder in folders:
        run = RunFolder.read(folder, unsealed=unsealed)
        entry = _entry(folder, run)
        recording = read_clip(entry)
        if entry.vehicle not in recording.vehicles.ids:
            ids = recording.vehicles.ids
            hint = suggestion(entry.vehicle, ids, "" if ids else "it has no vehicles")
            raise ConfigError(
                f"{folder}: [[crowd.recorded]] '{entry.name}': vehicle = '{entry.vehicle}': not in "
                f"'{recording.name}'; {hint}"
            )
        about = {"recording": recording.name, "vehicle": entry.vehicle}
        key = (recording.name, entry.vehicle)
        if key not in rows:
            seen = _while_driving(recording, entry.vehicle)
            own = _measures(seen, entry.vehicle, np.empty(0, dtype=np.str_))
            rows[key] = {"driver": RECORDED_DRIVER, **about, **own}
        kinds = run.pedestrians["contact"].to_numpy(dtype=np.str_)
        ego = next(iter(run.egos))
        own = _measures(recording_of_run(run, recording.dataset), ego, kinds)
        rows[(*key, str(folder))] = {"driver": folder.resolve().name, **about, **own}
    names = ("driver", "recording", "vehicle", *(name for name, _ in MEASURES))
    return pd.DataFrame(list(rows.values()), columns=list(names))


def _entry(folder: Path, run: RunFolder) -> RecordedConfig:
    """Return the entry of the recorded vehicle in whose place the first ego drove.

    Raises:
        ConfigError: there is none, or no ego drove.
    """
    named = [entry for entry in run.config.crowd.recorded if entry.vehicle]
    if not named:
        raise ConfigError(
            f"{folder}: no [[crowd.recorded]] with a vehicle; expected a run in place of a recorded"
            " vehicle: giveway data scenario writes a scenario for it"
        )
    if not run.egos:
        raise ConfigError(f"{folder}: no ego drove; expected a run with one")
    return named[0]


def _measures(recording: Recording, vehicle: str, kinds: NDArray[np.str_]) -> dict[str, object]:
    """Return the measures of one drive.

    Args:
        recording: Recording of the drive.
        vehicle: Id of the vehicle.
        kinds: Kinds of the contacts in a run; empty for a recorded drive, where overlaps count.
    """
    found = measure([recording], vehicle)
    (drive,) = found.drives.to_dict("records")
    people = found.people
    first = people["first"]
    touched = int((people["clearance"] < 0.0).sum())
    if len(kinds):
        touched = int(np.isin(kinds, [FRONTAL, SIDE]).sum())
    wanted = {name for name, _ in MEASURES}
    return {str(name): value for name, value in drive.items() if name in wanted} | {
        "clearance": people["clearance"].min(),
        "clearance_above_2": people["clearance_above_2"].min(),
        "short_ttc": int((people["time_to_collision"] < CRITICAL_TTC).sum()),
        "short_pet": int((people["post_encroachment_time"].abs() < SHORT_PET).sum()),
        "person_first": int((first == PERSON).sum()),
        "vehicle_first": int((first == VEHICLE).sum()),
        "touched": touched,
        "unaware": int((kinds == UNAWARE).sum()),
    }


def recording_of_run(run: RunFolder, dataset: Dataset | None = None) -> Recording:
    """Return the first ego of a run and its people as a recording.

    Args:
        run: Results of the run.
        dataset: Description that the recording gets; SUMO's if None.
    """
    step = run.step
    ego_id, ego = next(iter(run.egos)), run.ego
    ego = ego[ego["id"] == ego_id]
    start = float(ego["time"].iloc[0])
    people = run.trajectories[run.trajectories["type"] == "pedestrian"]
    people = people.sort_values(["id", "time"], kind="stable")
    length, width = run.scene.body(ego_id, (BODY.length, BODY.width))
    ids, track = np.unique(people["id"].to_numpy(dtype=np.str_), return_inverse=True)
    people_frames = _frames(people["time"], start, step)
    frames = _frames(ego["time"], start, step)
    inside = (people_frames >= 0) & (people_frames <= frames[-1])
    heading = np.radians(90.0 - ego["angle"].to_numpy(dtype=np.float64))
    return Recording(
        name=run.path.resolve().name,
        file=run.path,
        dataset=dataset or dataset_of("sumo_fcd"),
        frame_rate=1.0 / step,
        first_frame=0,
        frames=int(frames[-1]) + 1,
        people=_tracks(
            tuple(ids.tolist()),
            track[inside],
            people_frames[inside],
            people[["x", "y", "vx", "vy"]].to_numpy(dtype=np.float64)[inside],
            np.zeros((len(ids), 3)),
        ),
        vehicles=replace(
            _tracks(
                (ego_id,),
                np.zeros(len(ego), dtype=np.int64),
                frames,
                np.column_stack(
                    [
                        ego[["x", "y"]].to_numpy(dtype=np.float64),
                        ego["speed"].to_numpy(dtype=np.float64)[:, None]
                        * np.column_stack([np.cos(heading), np.sin(heading)]),
                    ]
                ),
                np.array([[0.0, length, width]]),
            ),
            heading=heading,
        ),
        defects=(),
    )


def _frames(time: "pd.Series[float]", start: float, step: float) -> NDArray[np.int64]:
    whole = np.rint((time.to_numpy(dtype=np.float64) - start) / step)
    return np.asarray(whole, dtype=np.int64)


def _tracks(
    ids: tuple[str, ...],
    track: NDArray[np.int64],
    frame: NDArray[np.int64],
    state: NDArray[np.float64],
    body: NDArray[np.float64],
) -> Tracks:
    """Return tracks from the rows (R, 4) of x, y [m], vx, vy [m/s]; those without a row are out."""
    velocity = state[:, 2:].copy()
    whole = Tracks(
        ids=ids,
        kinds=("",) * len(ids),
        track=track,
        frame=frame,
        position=state[:, :2].copy(),
        velocity=velocity,
        heading=directions(velocity),
        speed=np.hypot(velocity[:, 0], velocity[:, 1]),
        body=body,
    )
    return whole.only(np.isin(np.arange(len(ids)), track))


def _while_driving(recording: Recording, vehicle: str) -> Recording:
    """Return a recording with the people's rows between a vehicle's first and last instant."""
    vehicles, people = recording.vehicles, recording.people
    driven = vehicles.frame[vehicles.rows(vehicles.ids.index(vehicle))]
    inside = (people.frame >= driven[0]) & (people.frame <= driven[-1])
    state = np.column_stack([people.position, people.velocity])[inside]
    seen = _tracks(people.ids, people.track[inside], people.frame[inside], state, people.body)
    return replace(recording, people=seen)
