"""Clips of real pedestrians and vehicles: recordings as arrays over all frames.

CITR and DUT: Yang, Li, Redmill & Özgüner, "Top-view Trajectories: A Pedestrian Dataset of
Vehicle-Crowd Interaction from Controlled Experiments and Crowded Campus" (arXiv 1902.00487). Users
of the data sets are asked to cite this paper.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from giveway.errors import DatasetError
from giveway.geometry.kernel import Array
from giveway.recordings import Dataset, Recording, Tracks, read_recording, read_recordings
from giveway.recordings.recording import DUPLICATE

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
        ids: Ids (n,) of the pedestrians; 0 to n - 1 if one of them is no number.
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
    clips = [_clip(recording) for recording in read_recordings(folder, dataset)]
    names = [clip.name for clip in clips]
    for name in names:
        if names.count(name) > 1:
            raise DatasetError(f"{folder}: a clip of this name is in it twice: {name}; keep one")
    _require_rate(folder, clips)
    return tuple(clips)


def _require_rate(folder: Path, clips: list[Clip]) -> None:
    """Make sure that people's steps from frame to frame agree with their speeds.

    Raises:
        DatasetError: they belong to another frame rate.
    """
    rates = np.array([rate for clip in clips if (rate := _rate_of(clip)) is not None])
    if not len(rates):
        return
    dataset, found = clips[0].dataset, float(np.median(rates))
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
    return _clip(read_recording(file, dataset))


def _clip(recording: Recording) -> Clip:
    """Return a recording as a clip: the frames in which people are seen.

    Raises:
        DatasetError: there are no people, too many frames, or a person is twice in a frame.
    """
    people, vehicles = recording.people, recording.vehicles
    if not people.ids:
        raise DatasetError(
            f"{recording.file}: no pedestrians beside it; expected the file of {recording.name}'s "
            "pedestrians, or remove the vehicles'"
        )
    for defect in recording.defects:
        if defect.kind == DUPLICATE:
            raise DatasetError(f"{defect.example}; expected once")
    first, last = int(people.frame.min()), int(people.frame.max())
    if last - first >= _LONGEST:
        frames = f"frames {recording.first_frame + first} to {recording.first_frame + last}"
        raise DatasetError(f"{recording.file}: {frames}: expected at most {_LONGEST}")
    moving = np.column_stack([vehicles.position, vehicles.heading, vehicles.speed])
    whole = all(name.isdecimal() for name in people.ids)
    numbers = [int(name) for name in people.ids] if whole else range(len(people.ids))
    return Clip(
        recording.name,
        recording.dataset.model_copy(update={"frame_rate": recording.frame_rate}),
        recording.first_frame + first,
        np.array(numbers, dtype=np.int64),
        _spread(people, people.position, first, last),
        _spread(people, people.velocity, first, last),
        _spread(vehicles, moving, first, last),
    )


def _spread(tracks: Tracks, values: Array, first: int, last: int) -> Array:
    """Return the values (T, n, c) of tracks in each frame, nan without a row."""
    spread = np.full((last - first + 1, len(tracks.ids), values.shape[1]), np.nan)
    seen = (tracks.frame >= first) & (tracks.frame <= last)
    spread[tracks.frame[seen] - first, tracks.track[seen]] = values[seen]
    return spread
