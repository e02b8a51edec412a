"""The recorded tracks of people and vehicles in one right-handed frame [m], [m/s], [rad]."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.recordings.dataset import Dataset

DUPLICATE: Final = "duplicate row"
GAP: Final = "gap in a track"
RESTART: Final = "id starts again"
LABEL: Final = "other label"
RIDER: Final = "rider among people"
OVERLAP: Final = "person in a vehicle"
EMPTY_TIME: Final = "time empty or below 0"
LIGHTS: Final = "lights"
RATE: Final = "frame rate"


@dataclass(frozen=True)
class Defect:
    """One kind of defect of a recording.

    Attributes:
        kind: Kind of defect, like ``DUPLICATE``.
        count: Number of tracks, rows or pairs that have it.
        example: The first of them, in words.
    """

    kind: str
    count: int
    example: str


@dataclass(frozen=True, eq=False)
class Tracks:
    """The tracks of n people or vehicles: R rows in the order of tracks, and of time in each.

    Attributes:
        ids: Id of each track.
        kinds: Label of each track; empty where files have none.
        track: Track (R,) of each row.
        frame: Instant (R,) of each row; 0 is the first of the recording.
        position: Positions (R, 2) [m] of the tracked point.
        velocity: Velocities (R, 2) [m/s].
        heading: Headings (R,) [rad]; of people the direction of the velocity.
        speed: Speeds (R,) [m/s]; negative where a vehicle backs and the files say so.
        body: Front, rear and width (n, 3) [m] of each body, about the tracked point.
    """

    ids: tuple[str, ...]
    kinds: tuple[str, ...]
    track: NDArray[np.int64]
    frame: NDArray[np.int64]
    position: Array
    velocity: Array
    heading: Array
    speed: Array
    body: Array

    @property
    def bounds(self) -> NDArray[np.int64]:
        """The first row (n + 1,) of each track, and the number of rows."""
        return np.searchsorted(self.track, np.arange(len(self.ids) + 1))

    def rows(self, number: int) -> slice:
        """Return the rows of a track."""
        first, end = self.bounds[number : number + 2].tolist()
        return slice(first, end)

    def only(self, keep: NDArray[np.bool_]) -> "Tracks":
        """Return the tracks that a mask (n,) keeps."""
        rows = keep[self.track]
        renumbered = np.cumsum(keep) - 1
        kept = np.flatnonzero(keep).tolist()
        return Tracks(
            ids=tuple(self.ids[i] for i in kept),
            kinds=tuple(self.kinds[i] for i in kept),
            track=renumbered[self.track[rows]],
            frame=self.frame[rows],
            position=self.position[rows],
            velocity=self.velocity[rows],
            heading=self.heading[rows],
            speed=self.speed[rows],
            body=self.body[keep],
        )

    def peak(self) -> Array:
        """Return the largest speed (n,) [m/s] of each track."""
        if not self.ids:
            return np.empty(0)
        return np.maximum.reduceat(np.abs(self.speed), self.bounds[:-1])


@dataclass(frozen=True, eq=False)
class Recording:
    """The people and vehicles that one camera, or one simulation, has seen.

    Attributes:
        name: Name by its files, or by its folder.
        file: First of its files of tracks.
        dataset: Description of the data set.
        frame_rate: Instants per second [1/s].
        first_frame: Number in the files of the first instant.
        frames: Number of instants.
        people: Tracks of the people.
        vehicles: Tracks of the vehicles.
        defects: Defects that were found, some of which were mended.
    """

    name: str
    file: Path
    dataset: Dataset
    frame_rate: float
    first_frame: int
    frames: int
    people: Tracks
    vehicles: Tracks
    defects: tuple[Defect, ...]

    @property
    def duration(self) -> float:
        """The time [s] from the first to the last instant."""
        return (self.frames - 1) / self.frame_rate

    def walkers(self) -> "Recording":
        """Return the recording without the riders among its people, who become a defect."""
        riding = _riding(self.people, self.frame_rate)
        if not riding.any():
            return self
        first = self.people.ids[int(riding.argmax())]
        found = Defect(RIDER, int(riding.sum()), f"{first} is faster than {RIDING} m/s for 2 s")
        people = self.people.only(~riding)
        return replace(self, people=people, defects=(*self.defects, found))


RIDING = 3.5
"""Speed [m/s] above which, for two seconds on end, a person rides: twice a brisk walk."""
_SUSTAINED = 2.0  # Time [s] for which a rider keeps the speed


def _riding(people: Tracks, frame_rate: float) -> NDArray[np.bool_]:
    """Return whether each person (n,) is faster than ``RIDING`` for two seconds on end."""
    length = max(1, round(_SUSTAINED * frame_rate))
    fast = np.concatenate([[0], np.cumsum(people.speed > RIDING)])
    riding = np.zeros(len(people.ids), dtype=bool)
    whole = np.flatnonzero(fast[length:] - fast[:-length] == length)
    ends = people.track[whole + length - 1]
    riding[ends[people.track[whole] == ends]] = True
    return riding
