"""Replays of recordings: the vehicles as recorded, and people moved by a pedestrian model."""

import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from giveway.config import RunConfig
from giveway.crowd.generation.kinds import desired_speeds
from giveway.crowd.models import model_of
from giveway.crowd.motion.sway import sway_of
from giveway.crowd.roster import Roster
from giveway.geometry.kernel import Array
from giveway.recordings import Recording, Tracks
from pedestrian_model import (
    OPEN_GROUND,
    Crowd,
    CrowdModel,
    PedestrianModel,
    Surroundings,
    VciParameters,
    Vehicles,
)
from pedestrian_model.stepping import substeps

_STREAM = 0x5EED  # Key of the random stream of desired speeds
_SETTLING = 0.5  # Time [s] skipped at the start of a recording, in which filters settle
_BEYOND = 30.0  # Distance [m] that people want to go on from their last recorded place
_HARDLY = 0.6  # Speed [m/s] in the first second, up to which the desired speed is drawn
_STANDING = 0.3  # Speed [m/s] below which somebody stands at the end
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


def replayed(
    recording: Recording,
    config: RunConfig,
    draw: int = 0,
    parameters: VciParameters | None = None,
) -> Recording:
    """Return the recording with all its people simulated together, and its vehicles as recorded.

    Each person enters at the recorded place and velocity, walks to the last recorded place and on
    from there, and leaves at the recorded end. The desired speed is the largest of the first
    second, since a predictor of behaviour should not know of later. Who hardly walks then has a
    drawn one, as in any crowd. People sway as the preset says. The vehicles react to nobody.

    Args:
        recording: Recording, see :func:`settled`.
        config: Configuration that names the pedestrian model, its preset, and the seed.
        draw: Number of the draw; another one has other desired speeds and another sway.
        parameters: Parameters of VCI in place of the preset's, or None.

    Raises:
        GivewayError: the model cannot be made.
        PedestrianModelError: a person's state is not finite.
    """
    people = recording.people
    begun = _begun(people, round(_SHORTEST * recording.frame_rate))
    shown = np.where(begun > _HARDLY, begun, np.nan)
    seed, desired_speed = drawn(recording, config, draw, shown)
    walks = Walks(desired_speed, _routes(people), _last(people))
    return walked(recording, config, walks, seed, parameters)


@dataclass(frozen=True, eq=False)
class Walks:
    """The walks that n people have before them.

    Attributes:
        desired_speed: Desired speed (n,) [m/s] of each person.
        routes: Way-points (n, k, 2) [m].
        last: Last instant (n,) of each person.
        passages: Passages (k, 3) of all routes, see ``Crowd.create``; None if there are none.
        surroundings: Walls.
        left: Function that returns who (m,) has left by their places (m, 2), or None if everybody
            stays until the last instant.
    """

    desired_speed: Array
    routes: Array
    last: NDArray[np.int64]
    passages: Array | None = None
    surroundings: Surroundings = OPEN_GROUND
    left: Callable[[Array], NDArray[np.bool_]] | None = None


def walked(
    recording: Recording,
    config: RunConfig,
    walks: Walks,
    seed: int,
    parameters: VciParameters | None = None,
) -> Recording:
    """Return the recording with its people simulated, who enter where, when and as fast as it says.

    Args:
        recording: Recording, see :func:`settled`.
        config: Configuration that names the pedestrian model, its preset, and the seed.
        walks: Walks of the people.
        seed: Seed of the sway.
        parameters: Parameters of VCI in place of the preset's, or None.

    Raises:
        GivewayError: the model cannot be made.
        PedestrianModelError: a person's state is not finite.
    """
    people, bounds = recording.people, recording.people.bounds
    first, last = _first(people), walks.last.copy()
    start = np.concatenate([[0], np.cumsum(last - first + 1)])
    position, velocity = np.empty((start[-1], 2)), np.empty((start[-1], 2))
    position[start[:-1]] = people.position[bounds[:-1]]
    velocity[start[:-1]] = people.velocity[bounds[:-1]]
    passed = np.zeros(len(people.ids), dtype=np.int64)
    parts = substeps(1.0 / recording.frame_rate)
    step = 1.0 / recording.frame_rate / parts
    roster = Roster(people.ids)
    model: PedestrianModel = (
        CrowdModel(parameters, step) if parameters else model_of(config, step, roster)
    )
    sway = sway_of(config, model, seed)
    vehicles = _Vehicles(recording.vehicles)
    now = np.empty(0, dtype=np.int64)
    crowd = None
    for k in range(int(first.min(initial=recording.frames)), int(last.max(initial=0))):
        there = np.flatnonzero((first <= k) & (k < last))
        rows = start[there] + k - first[there]
        if crowd is None or not np.array_equal(there, now):
            now = roster.person_ids = there
            crowd = Crowd.create(
                position[rows],
                velocity[rows],
                walks.desired_speed[there],
                list(walks.routes[there]),
                passages=None if walks.passages is None else [walks.passages] * len(there),
            )
            crowd.waypoint_index[:] = passed[there]
        for part in range(parts):
            now_there = Vehicles(vehicles.at(k, part * step))
            if sway is None:
                model.advance(crowd, now_there, walks.surroundings)
            else:
                sway.advance(crowd, now_there, walks.surroundings, there, len(people.ids))
        position[rows + 1], velocity[rows + 1] = crowd.position, crowd.velocity
        passed[there] = crowd.waypoint_index
        if walks.left is not None:
            last[there[walks.left(crowd.position)]] = k + 1
    return replace(recording, people=_walked(people, (first, last), start, position, velocity))


def drawn(recording: Recording, config: RunConfig, draw: int, shown: Array) -> tuple[int, Array]:
    """Return the seed of a draw's sway, and the desired speeds (n,) [m/s] of its people.

    Args:
        recording: Recording of n people.
        config: Configuration that names the distribution and bounds of desired speeds, and a seed.
        draw: Number of the draw.
        shown: Desired speed (n,) [m/s] that each person shows, or nan: it is drawn as in any crowd.
    """
    seed = zlib.crc32(f"{recording.name} {config.seed} {draw}".encode())
    random = np.random.default_rng((seed, _STREAM))
    any_speeds = desired_speeds(config.crowd, ("",) * len(shown), random)
    bounds = config.crowd.desired_speed_bounds
    return seed, np.where(np.isnan(shown), any_speeds, shown.clip(*bounds))


def _routes(people: Tracks) -> Array:
    """Return the way-points (n, 2, 2) [m] of each person: the last recorded place, and beyond.

    Beyond lies in the last recorded direction. Who stands at the end is bound for that place.
    """
    last = people.bounds[1:] - 1
    place, velocity = people.position[last], people.velocity[last]
    speed = np.hypot(velocity[:, 0], velocity[:, 1])[:, None]
    on = np.where(speed > _STANDING, _BEYOND * velocity / np.maximum(speed, _STANDING), 0.0)
    return np.stack([place, place + on], axis=1)


def _begun(people: Tracks, frames: int) -> Array:
    """Return the largest speed (n,) [m/s] of each person in the first ``frames``."""
    first = people.bounds[:-1]
    early = people.frame - people.frame[first][people.track] <= frames
    largest = np.zeros(len(people.ids))
    np.maximum.at(largest, people.track[early], people.speed[early])
    return largest


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
    seen: tuple[NDArray[np.int64], NDArray[np.int64]],
    start: NDArray[np.int64],
    place: Array,
    velocity: Array,
) -> Tracks:
    """Return the tracks of simulated people, with a row at every instant of ``seen``."""
    first, last = seen
    track = np.repeat(np.arange(len(people.ids)), np.diff(start))
    frame = first[track] + np.arange(start[-1]) - start[track]
    rows = frame <= last[track]
    place, velocity = place[rows], velocity[rows]
    return replace(
        people,
        track=track[rows],
        frame=frame[rows],
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
