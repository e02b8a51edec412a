"""Replays of recordings: the vehicles as recorded, and people moved by a pedestrian model."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.crowd.models import model_of
from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from giveway.recordings import Recording, Tracks
from giveway.validation.predictors import crowd_of
from pedestrian_model import Vehicles
from pedestrian_model.stepping import substeps

_SETTLING = 0.5  # Time [s] skipped at the start of a recording, in which filters settle
_SHORTEST = 1.0  # Time [s] for which a person must be seen


def settled(recording: Recording) -> Recording:
    """Return the recording without its first half second, riders, and people seen for under 1 s.

    Args:
        recording: Recording as it was read.
    """
    recording = recording.walkers()
    people = _later(recording.people, round(_SETTLING * recording.frame_rate))
    long = _last(people) - _first(people) >= round(_SHORTEST * recording.frame_rate)
    return replace(recording, people=people.only(long))


def replayed(recording: Recording, config: RunConfig) -> Recording:
    """Return the recording with all its people simulated together, and its vehicles as recorded.

    Each person enters at the recorded place and velocity, walks at the desired speed of the model's
    parameters towards the last recorded place, and leaves at the recorded end. The vehicles react
    to nobody.

    Args:
        recording: Recording, see :func:`settled`.
        config: Configuration that names the pedestrian model and its preset.

    Raises:
        GivewayError: the model cannot be made.
        PedestrianModelError: a person's state is not finite.
    """
    people, bounds = recording.people, recording.people.bounds
    first, last = _first(people), _last(people)
    start = np.concatenate([[0], np.cumsum(last - first + 1)])
    position, velocity = np.empty((start[-1], 2)), np.empty((start[-1], 2))
    position[start[:-1]] = people.position[bounds[:-1]]
    velocity[start[:-1]] = people.velocity[bounds[:-1]]
    destination = people.position[bounds[1:] - 1]
    parts = substeps(1.0 / recording.frame_rate)
    step = 1.0 / recording.frame_rate / parts
    roster = Roster(people.ids)
    model = model_of(config, step, roster)
    vehicles = _Vehicles(recording.vehicles)
    now = np.empty(0, dtype=np.int64)
    crowd = None
    for k in range(int(first.min(initial=recording.frames)), int(last.max(initial=0))):
        there = np.flatnonzero((first <= k) & (k < last))
        rows = start[there] + k - first[there]
        if crowd is None or not np.array_equal(there, now):
            now = roster.person_ids = there
            crowd = crowd_of(
                position[rows],
                velocity[rows],
                destination[there],
                model.parameters.desired_speed,
            )
        for part in range(parts):
            model.advance(crowd, Vehicles(vehicles.at(k, part * step)))
        position[rows + 1], velocity[rows + 1] = crowd.position, crowd.velocity
    return replace(recording, people=_walked(people, first, start, position, velocity))


class _Vehicles:
    """The recorded vehicles by instant, as the pedestrian model takes them."""

    def __init__(self, tracks: Tracks) -> None:
        order = np.argsort(tracks.frame, kind="stable")
        self._frame = tracks.frame[order]
        self._rows = np.column_stack(
            [tracks.position, tracks.heading, tracks.speed, tracks.body[tracks.track]]
        )[order]

    def at(self, frame: int, later: float) -> Array:
        """Return the vehicles (m, 7) some time [s] after an instant, at constant velocity."""
        first, end = np.searchsorted(self._frame, [frame, frame + 1]).tolist()
        rows: Array = self._rows[first:end].copy()
        along = np.column_stack([np.cos(rows[:, 2]), np.sin(rows[:, 2])])
        rows[:, :2] += later * rows[:, 3:4] * along
        return rows


def _walked(
    people: Tracks,
    first: NDArray[np.int64],
    start: NDArray[np.int64],
    place: Array,
    velocity: Array,
) -> Tracks:
    """Return the tracks of simulated people, with a row at every instant."""
    track = np.repeat(np.arange(len(people.ids)), np.diff(start))
    frame = first[track] + np.arange(start[-1]) - start[track]
    return replace(
        people,
        track=track,
        frame=frame,
        position=place,
        velocity=velocity,
        heading=np.arctan2(velocity[:, 1], velocity[:, 0]),
        speed=np.hypot(velocity[:, 0], velocity[:, 1]),
    )


def _later(tracks: Tracks, frame: int) -> Tracks:
    """Return the tracks from an instant on."""
    tracks = tracks.only(_last(tracks) >= frame)
    rows = tracks.frame >= frame
    return replace(
        tracks,
        track=tracks.track[rows],
        frame=tracks.frame[rows],
        position=tracks.position[rows],
        velocity=tracks.velocity[rows],
        heading=tracks.heading[rows],
        speed=tracks.speed[rows],
    )


def _first(tracks: Tracks) -> NDArray[np.int64]:
    """Return the first instant (n,) of each track."""
    return tracks.frame[tracks.bounds[:-1]]


def _last(tracks: Tracks) -> NDArray[np.int64]:
    """Return the last instant (n,) of each track."""
    return tracks.frame[tracks.bounds[1:] - 1]
