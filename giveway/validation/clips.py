"""Clips of real pedestrians and vehicles: CSV files like those of CITR, as arrays in one frame.

CITR and DUT: Yang, Li, Redmill & Özgüner, "Top-view Trajectories: A Pedestrian Dataset of
Vehicle-Crowd Interaction from Controlled Experiments and Crowded Campus" (arXiv 1902.00487). Users
of the data sets are asked to cite this paper.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.validation.dataset import Dataset

PEDESTRIANS: Final = "_traj_ped_filtered.csv"
VEHICLES: Final = "_traj_veh_filtered.csv"
_PEDESTRIAN_COLUMNS: Final = ("x_est", "y_est", "vx_est", "vy_est")
_VEHICLE_COLUMNS: Final = ("x_est", "y_est", "psi_est", "vel_est")
_FARTHEST = 1e5  # Largest coordinate [m] in a camera's view
_LONGEST = 200_000  # Largest number of frames: nearly two hours
_WALKING = 0.5  # Speed [m/s] above which pedestrians are used to check the frame rate
# Largest relative difference between the given frame rate and the one from speeds
_RATES_APART = 0.1


@dataclass(frozen=True, eq=False)
class Clip:
    """One recording, in a right-handed frame: x as in the image, y up.

    Attributes:
        name: Name of its files, like ``front_interaction_01``.
        dataset: Description of the data set, which its files lack.
        first_frame: Number in the data set of this clip's frame 0.
        ids: Ids (n,) of the pedestrians.
        position: Positions (T, n, 2) [m]; nan where a pedestrian is not seen.
        velocity: Velocities (T, n, 2) [m/s]; nan as for positions.
        poses: Poses (T, m, 4) of the vehicles: x, y [m], heading [rad], speed [m/s]; nan where a
            vehicle is not seen.
    """

    name: str
    dataset: Dataset
    first_frame: int
    ids: NDArray[np.int64]
    position: Array
    velocity: Array
    poses: Array

    @property
    def frames(self) -> int:
        """The number T of frames."""
        return int(self.position.shape[0])

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Flags (T, n) of the pedestrians that are seen."""
        return ~np.isnan(self.position[:, :, 0])

    @property
    def last_seen(self) -> NDArray[np.int64]:
        """The last frame (n,) in which each pedestrian is seen."""
        last: NDArray[np.int64] = self.frames - 1 - self.seen[::-1].argmax(axis=0)
        return last

    @property
    def destination(self) -> Array:
        """The last observed place (n, 2) [m] of each pedestrian."""
        return self.position[self.last_seen, np.arange(len(self.ids))]


def read_clips(folder: Path, dataset: Dataset) -> tuple[Clip, ...]:
    """Read all clips below ``folder``, in the order of their paths.

    Args:
        folder: Folder of the data set, or any part of it; clips are recognised by file name.
        dataset: Description of the data set, which its files lack.

    Raises:
        DatasetError: there is no such folder, it has no clip, a file cannot be used, or people's
            speeds and steps belong to another frame rate.
    """
    if not folder.is_dir():
        raise DatasetError(f"{folder}: no such folder; expected a data set's, or a part of it")
    files = sorted(folder.rglob(f"*{PEDESTRIANS}"))
    for file in sorted(folder.rglob(f"*{VEHICLES}")):
        partner = file.with_name(file.name.removesuffix(VEHICLES) + PEDESTRIANS)
        if not partner.is_file():
            raise DatasetError(
                f"{file}: no pedestrians beside it; expected {partner.name}, or remove the file"
            )
    if not files:
        raise DatasetError(
            f"{folder}: no clip found; expected files *{PEDESTRIANS} in it or its folders"
        )
    clips = [read_clip(file, dataset) for file in files]
    names: dict[str, Path] = {}
    for clip, file in zip(clips, files, strict=True):
        if names.setdefault(clip.name, file) != file:
            raise DatasetError(
                f"{file}: a clip of this name is in {names[clip.name].parent} too; keep one"
            )
    _require_rate(folder, clips, dataset)
    return tuple(clips)


def _require_rate(folder: Path, clips: list[Clip], dataset: Dataset) -> None:
    """Make sure that people's steps from frame to frame agree with their speeds.

    Raises:
        DatasetError: they belong to another frame rate.
    """
    rates = np.array([rate for clip in clips if (rate := _rate_of(clip)) is not None])
    if not len(rates):
        return
    found = float(np.median(rates))
    if abs(found / dataset.frame_rate - 1.0) > _RATES_APART:
        raise DatasetError(
            f"{folder}: people's speeds and their steps from frame to frame belong to {found:.1f} "
            f"frames per second, --dataset {dataset.name} has {dataset.frame_rate:g}; name the "
            "data set that it is, or correct its description"
        )


def _rate_of(clip: Clip) -> float | None:
    """Return the frame rate [1/s] by the walkers' speeds and steps, or None without walkers."""
    step = np.linalg.norm(np.diff(clip.position, axis=0), axis=2)
    speed = np.linalg.norm(clip.velocity, axis=2)
    speed = 0.5 * (speed[1:] + speed[:-1])
    with np.errstate(invalid="ignore"):
        walking = (speed > _WALKING) & (step > 0.0)
    return float(np.median(speed[walking] / step[walking])) if walking.any() else None


def read_clip(file: Path, dataset: Dataset) -> Clip:
    """Read the clip in a file of pedestrians, with the file of vehicles in its folder, if any.

    Raises:
        DatasetError: a file cannot be read, or a column, row or number is not as it should be.
    """
    name = file.name.removesuffix(PEDESTRIANS)
    of_vehicles = file.with_name(name + VEHICLES)
    pedestrians = _read(file, _PEDESTRIAN_COLUMNS)
    vehicles = _read(of_vehicles, _VEHICLE_COLUMNS) if of_vehicles.is_file() else None
    first = int(pedestrians["frame"].min())
    last = int(pedestrians["frame"].max())
    if last - first >= _LONGEST:
        raise DatasetError(f"{file}: frames {first} to {last}: expected at most {_LONGEST}")
    ids, rows = _spread(pedestrians, _PEDESTRIAN_COLUMNS, first, last)
    poses = np.empty((last - first + 1, 0, 4))
    if vehicles is not None:
        poses = _spread(vehicles, _VEHICLE_COLUMNS, first, last)[1]
    # in a frame with y up, y, headings and lateral velocities change their sign
    if dataset.y_axis == "down":
        rows[:, :, [1, 3]] *= -1.0
        poses[:, :, [1, 2]] *= -1.0
    position = np.ascontiguousarray(rows[:, :, :2])
    velocity = np.ascontiguousarray(rows[:, :, 2:])
    return Clip(name, dataset, first, ids, position, velocity, poses)


def _spread(
    table: pd.DataFrame, columns: tuple[str, ...], first: int, last: int
) -> tuple[NDArray[np.int64], Array]:
    """Return the ids (k,), and their values (T, k, c) in each frame, nan without a row."""
    table = table[table["frame"].between(first, last)]
    ids, who = np.unique(table["id"].to_numpy(), return_inverse=True)
    values = np.full((last - first + 1, len(ids), len(columns)), np.nan)
    values[table["frame"].to_numpy() - first, who] = table[list(columns)].to_numpy()
    return ids.astype(np.int64), values


def _read(file: Path, columns: tuple[str, ...]) -> pd.DataFrame:
    try:
        table = pd.read_csv(file, dtype=str, keep_default_na=False)
    except (OSError, ValueError) as error:  # pandas' and Unicode's errors are ValueErrors
        reason = error.strerror if isinstance(error, OSError) else str(error).splitlines()[0]
        raise DatasetError(
            f"{file}: cannot be read as CSV ({reason}); take the file from the dataset again"
        ) from error
    missing = [name for name in ("id", "frame", *columns) if name not in table.columns]
    if missing:
        expected = ",".join(("id", "frame", "label", *columns))
        raise DatasetError(f"{file}: column '{missing[0]}' is missing; expected {expected}")
    if table.empty:
        raise DatasetError(f"{file}: no rows; take the file from the dataset again")
    numbers = pd.DataFrame({name: _numbers(file, table, name) for name in ("id", "frame")})
    numbers = numbers.astype(np.int64)
    for name in columns:
        numbers[name] = _numbers(file, table, name)
    twice = numbers.duplicated(["id", "frame"])
    if twice.any():
        row = int(twice.to_numpy().argmax())
        who, frame = (int(numbers[name].iloc[row]) for name in ("id", "frame"))
        raise DatasetError(
            f"{file}: line {row + 2}: id {who} is in frame {frame} twice; expected once"
        )
    return numbers


def _numbers(file: Path, table: pd.DataFrame, name: str) -> NDArray[np.float64]:
    """Return a column as finite numbers."""
    values = pd.to_numeric(table[name], errors="coerce").to_numpy(dtype=np.float64)
    whole = name in {"id", "frame"}
    with np.errstate(invalid="ignore"):
        bad = ~(np.abs(values) <= (1e9 if whole else _FARTHEST))
        bad |= whole & (values != np.floor(values))
    if bad.any():
        row = int(bad.argmax())
        expected = "a whole number" if whole else "a finite number"
        found = str(table[name].iloc[row])
        raise DatasetError(f"{file}: line {row + 2}: {name} = {found!r}: expected {expected}")
    return values
