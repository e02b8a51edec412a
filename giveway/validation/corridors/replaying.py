"""Replays of people in a corridor: they enter as recorded, and walk through it by a model."""

import numpy as np

from giveway.config import RunConfig
from giveway.geometry.kernel import Array
from giveway.recordings import Recording
from giveway.validation.behaviour.replaying import Walks, drawn, walked
from giveway.validation.corridors.geometry import StraightCorridor

LONGER = 1.5
"""Time that people have, as a share of the recording's."""
_AHEAD, _BESIDE = 2.5, 0.5  # Distances [m] ahead and beside within which free people see nobody
_FREE = 0.5  # Time [s] for which somebody must be free to show a desired speed
_BEHIND = 2.0  # Distance [m] behind the exit at which people leave


def replayed_in(
    corridor: StraightCorridor, recording: Recording, config: RunConfig, draw: int = 0
) -> Recording:
    """Return the recording with its people simulated between the walls of the corridor.

    Each person enters at the recorded instant, place and velocity, and leaves 2 m behind the exit.
    The desired speed is the one shown while free, see :func:`free_speeds`, or else drawn as in any
    crowd. People have half as much time again as the recording has.

    Args:
        corridor: Corridor of the recording.
        recording: Recording without vehicles, see ``settled``.
        config: Configuration of the crowd: model, preset, desired speeds; and the seed.
        draw: Number of the draw; another one has other desired speeds and another sway.

    Raises:
        GivewayError: the model cannot be made.
        PedestrianModelError: a person's state is not finite.
    """
    count = len(recording.people.ids)
    seed, desired_speed = drawn(recording, config, draw, free_speeds(corridor, recording))
    route, passages = corridor.route()
    walks = Walks(
        desired_speed,
        np.tile(route, (count, 1, 1)),
        np.full(count, round(LONGER * recording.frames)),
        passages,
        corridor.surroundings(),
        lambda position: corridor.along(position) > corridor.length + _BEHIND,
    )
    return walked(recording, config, walks, seed)


def free_speeds(corridor: StraightCorridor, recording: Recording) -> Array:
    """Return the speed (n,) [m/s] along the corridor that each person shows while free, or nan.

    It is the median of the instants in the corridor, at least 2.5 m before its exit, with nobody
    less than 2.5 m ahead and 0.5 m beside. Who has less than half a second of them shows none.
    """
    people = recording.people
    along, across = corridor.along(people.position), corridor.across(people.position)
    order = np.argsort(people.frame, kind="stable")
    free = np.zeros(len(order), dtype=bool)
    for rows in np.split(order, np.flatnonzero(np.diff(people.frame[order])) + 1):
        ahead = along[rows] - along[rows][:, None]
        beside = np.abs(across[rows] - across[rows][:, None])
        free[rows] = ~((ahead > 0.0) & (ahead < _AHEAD) & (beside < _BESIDE)).any(axis=1)
    free &= (along > 0.0) & (along < corridor.length - _AHEAD)
    speed = people.velocity @ np.array(corridor.direction)
    found = np.full(len(people.ids), np.nan)
    for who in range(len(people.ids)):
        shown = speed[people.rows(who)][free[people.rows(who)]]
        if len(shown) >= max(1.0, _FREE * recording.frame_rate):
            found[who] = np.median(shown)
    return found
