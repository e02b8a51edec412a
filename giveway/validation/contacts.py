"""Replays of whole clips, and the numbers of pedestrians that touch the vehicle in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.validation.clips import Clip
from giveway.validation.predictors import (
    CV,
    GOAL_CV,
    NO_VEHICLE,
    VCI,
    crowd_of,
    straight_on,
    straight_to,
)
from giveway.validation.protocol import Protocol, distance_to_bodies, vehicle_rows
from pedestrian_model import CrowdModel, VciParameters, Vehicles

DATA = "data"
ORDER = (DATA, CV, GOAL_CV, NO_VEHICLE, VCI)


@dataclass(frozen=True, eq=False)
class _Presence:
    """The first and last frame in which each pedestrian is in a clip."""

    who: NDArray[np.int64]
    first: NDArray[np.int64]
    last: NDArray[np.int64]

    @classmethod
    def of(cls, clip: Clip, skip: int) -> _Presence:
        seen = clip.seen[skip:]
        who = np.flatnonzero(seen.any(axis=0))
        return cls(who, skip + seen[:, who].argmax(axis=0), clip.last_seen[who])


def replay(clip: Clip, parameters: VciParameters, protocol: Protocol) -> dict[str, Array]:
    """Return the tracks (T, n, 2) [m] of the data and of each predictor, from the first frame on.

    All pedestrians enter at their recorded place and velocity, and leave at their recorded end.
    """
    presence = _Presence.of(clip, protocol.skip)
    bodies = vehicle_rows(clip, protocol)
    without = replace(parameters, vehicle_strength=0.0)
    data = np.full_like(clip.position, np.nan)
    data[protocol.skip :] = clip.position[protocol.skip :]
    return {
        DATA: data,
        CV: _alone(clip, presence, protocol.time_step, towards=False),
        GOAL_CV: _alone(clip, presence, protocol.time_step, towards=True),
        NO_VEHICLE: _jointly(clip, presence, bodies, without, protocol.time_step),
        VCI: _jointly(clip, presence, bodies, parameters, protocol.time_step),
    }


def _alone(clip: Clip, presence: _Presence, time_step: float, *, towards: bool) -> Array:
    """Move each pedestrian at constant velocity, or at constant speed to the destination."""
    out = np.full_like(clip.position, np.nan)
    for i, first, last in zip(presence.who, presence.first, presence.last, strict=True):
        x, v = clip.position[first, i][None], clip.velocity[first, i][None]
        frames = int(last - first)
        goal = clip.destination[i][None]
        ahead = straight_to(x, v, goal, time_step, frames) if towards else None
        ahead = straight_on(x, v, time_step, frames) if ahead is None else ahead
        out[first, i] = x[0]
        out[first + 1 : last + 1, i] = ahead[:, 0]
    return out


def _jointly(
    clip: Clip, presence: _Presence, bodies: Array, parameters: VciParameters, time_step: float
) -> Array:
    """Move all pedestrians by the model; they enter and leave as in the data."""
    model = CrowdModel(parameters, time_step)
    out, velocity = np.full_like(clip.position, np.nan), clip.velocity.copy()
    out[presence.first, presence.who] = clip.position[presence.first, presence.who]
    there = np.empty(0, dtype=np.int64)
    crowd = None
    for k in range(int(presence.first.min(initial=clip.frames)), clip.frames - 1):
        now = presence.who[(presence.first <= k) & (k < presence.last)]
        if crowd is None or not np.array_equal(now, there):
            there = now
            destination = clip.destination[there]
            crowd = crowd_of(
                out[k, there], velocity[k, there], destination, parameters.desired_speed
            )
        model.advance(crowd, Vehicles(bodies[k]))
        out[k + 1, there], velocity[k + 1, there] = crowd.position, crowd.velocity
    return out


def contact_table(
    clips: Sequence[Clip],
    parameters: VciParameters,
    protocol: Protocol,
    advance: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Count pedestrians that touch a vehicle in each clip with one, for data and predictors.

    Columns: clip, predictor, pedestrians, touching, closest [m]. ``closest`` is the smallest
    clearance between a pedestrian and the body, negative at a contact. A pedestrian is a disc with
    the model's radius.
    """
    rows = []
    for clip in clips:
        if clip.poses.shape[1] == 0:
            continue
        bodies = vehicle_rows(clip, protocol)
        for name, track in replay(clip, parameters, protocol).items():
            distance = np.nan_to_num(distance_to_bodies(track, bodies), nan=np.inf)
            skin = distance.min(axis=0) - parameters.body_radius
            people = int((~np.isnan(track[:, :, 0])).any(axis=0).sum())
            touching = int((skin < 0.0).sum())
            rows.append((clip.name, name, people, touching, float(skin.min(initial=np.inf))))
        advance()
    return pd.DataFrame(rows, columns=["clip", "predictor", "pedestrians", "touching", "closest"])


def people_apart(
    clips: Sequence[Clip], parameters: VciParameters, protocol: Protocol
) -> dict[str, float]:
    """Return the smallest distance [m] between two people's centres, in data and model.

    Whole clips are replayed, as for the contacts. A fit may reduce the mean error by letting people
    walk through each other, which this distance shows. It is infinite if there are never two
    people.
    """
    apart = {DATA: np.inf, VCI: np.inf}
    for clip in clips:
        presence = _Presence.of(clip, protocol.skip)
        bodies = vehicle_rows(clip, protocol)
        tracks = {
            DATA: clip.position[protocol.skip :],
            VCI: _jointly(clip, presence, bodies, parameters, protocol.time_step),
        }
        for name, track in tracks.items():
            apart[name] = min(apart[name], _least_apart(track))
    return apart


def _least_apart(track: Array) -> float:
    """Return the smallest distance [m] between any two of n people (T, n, 2) at any instant."""
    least = np.inf
    for i in range(track.shape[1] - 1):
        away = track[:, i + 1 :] - track[:, i : i + 1]
        distance = np.hypot(away[:, :, 0], away[:, :, 1])
        least = min(least, float(np.nan_to_num(distance, nan=np.inf).min()))
    return least
