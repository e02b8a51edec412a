"""Recorded people and vehicles in the network of a run, on the run's clock."""

import re
from collections.abc import Sequence

import numpy as np

from giveway.config.tables.crowd import DESIRED_SPEEDS
from giveway.config.tables.recorded import RecordedConfig
from giveway.crowd.generation.recorded import RecordedPerson
from giveway.errors import ConfigError
from giveway.geometry.kernel import Array
from giveway.recordings.recording import Recording

_WALKING = 0.2  # Speed [m/s] above which a person walks
_LAST = 1.0  # Time [s] at the end of a track that tells the last direction
_GOING = 0.2  # Distance [m] covered in that time by a person who has a direction
_OUTSIDE = 50.0  # Largest distance [m] of people from the network
_NOT_IN_IDS = re.compile(r"[^A-Za-z0-9_.#-]")


def people_of_run(
    entry: RecordedConfig, recording: Recording, prefix: str
) -> tuple[RecordedPerson, ...]:
    """Return the people of a recording as they come into a run, in the order of their ids.

    Args:
        entry: Entry of the configuration, which places the recording.
        recording: Recording.
        prefix: Prefix of their ids in the run; their ids in the files follow.
    """
    tracks = recording.people
    time = entry.begin + tracks.frame / recording.frame_rate
    position, velocity = placed(entry, tracks.position), turned(entry, tracks.velocity)
    names = _names(tracks.ids, prefix)
    people = []
    for number, name in enumerate(names):
        rows = tracks.rows(number)
        if rows.stop - rows.start < 2:
            continue  # seen for one instant
        at = position[rows]
        people.append(
            RecordedPerson(
                name=name,
                time=time[rows],
                position=at,
                velocity=velocity[rows],
                desired_speed=_desired(tracks.speed[rows]),
                destination=at[-1] + entry.walk_on * _last_direction(time[rows], at),
            )
        )
    return tuple(people)


def placed(entry: RecordedConfig, points: Array) -> Array:
    """Return points (n, 2) [m] of a recording in the network of the run."""
    return np.asarray(turned(entry, points) + np.array([entry.x, entry.y]))


def turned(entry: RecordedConfig, vectors: Array) -> Array:
    """Return vectors (n, 2) of a recording along the axes of the network."""
    c, s = np.cos(np.radians(entry.heading)), np.sin(np.radians(entry.heading))
    return np.asarray(np.einsum("ij,jk", vectors, np.array([[c, s], [-s, c]])))


def require_inside(
    entry: RecordedConfig,
    people: Sequence[RecordedPerson],
    boundary: tuple[float, float, float, float],
) -> None:
    """Make sure that recorded people walk where the network is.

    Args:
        entry: Entry of the configuration.
        people: People of the recording, in the network.
        boundary: Bounds x_min, y_min, x_max, y_max of the network [m].

    Raises:
        ConfigError: all of them are far outside, or the run begins after the recording.
    """
    heading = f"[[crowd.recorded]] '{entry.name}'"
    if not people or max(float(person.time[-1]) for person in people) <= 0.0:
        raise ConfigError(
            f"{heading}: begin = {entry.begin:g}: nobody is left when the run starts; expected a "
            "recording that is longer before its end, or a larger begin [s]"
        )
    places = np.concatenate([person.position for person in people])
    low, high = places.min(axis=0), places.max(axis=0)
    bounds = np.array(boundary)
    if (low > bounds[2:] + _OUTSIDE).any() or (high < bounds[:2] - _OUTSIDE).any():
        raise ConfigError(
            f"{heading}: x = {entry.x:g}, y = {entry.y:g}: its people walk from "
            f"{low[0]:.0f},{low[1]:.0f} to {high[0]:.0f},{high[1]:.0f} m, outside of the network, "
            f"which reaches from {bounds[0]:.0f},{bounds[1]:.0f} to {bounds[2]:.0f},"
            f"{bounds[3]:.0f} m; move the recording (x, y, heading)"
        )


def _names(ids: Sequence[str], prefix: str) -> list[str]:
    """Return ids that SUMO takes, one for each id of the files."""
    names = [prefix + _NOT_IN_IDS.sub("_", name) for name in ids]
    return [
        name if names.count(name) == 1 else f"{name}_{number}" for number, name in enumerate(names)
    ]


def _desired(speed: Array) -> float:
    """Return the median of the speeds (R,) [m/s] of a person while walking."""
    walking = speed[speed > _WALKING]
    median = float(np.median(walking)) if len(walking) else DESIRED_SPEEDS[0]
    return min(max(median, DESIRED_SPEEDS[0]), DESIRED_SPEEDS[1])


def _last_direction(time: Array, position: Array) -> Array:
    """Return the unit direction (2,) in which a person went last; 0, 0 of one who stood."""
    first = int(np.searchsorted(time, time[-1] - _LAST))
    way = position[-1] - position[first]
    length = float(np.hypot(*way))
    return np.asarray(way / length) if length > _GOING else np.zeros(2)
