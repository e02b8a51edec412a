"""The windows of clips in which tracks are predicted, cut as is usual in the field.

Errors are ADE and FDE, the mean and the final displacement between predicted and observed positions
(Pellegrini, Ess, Schindler & van Gool, "You'll Never Walk Alone", ICCV 2009; Alahi et al., "Social
LSTM", CVPR 2016).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.recordings.dataset import CITR, Dataset
from giveway.validation.clips import Clip

_PAUSE = 0.5  # Time [s] skipped at the start, and between the starts of windows
_HORIZONS = (0.75, 2.0, 4.0)  # Prediction horizons [s]
_PAST = 3.0  # Time [s] before a window of which the predictors know the tracks
_NOWHERE = 1e6  # Place [m] of a vehicle in frames in which it is not seen, or does not count


@dataclass(frozen=True)
class Protocol:
    """The rules for cutting and judging clips; by default those of CITR."""

    frame_rate: float = CITR.frame_rate  # [1/s]
    skip: int = 15  # frames at the start, in which the dataset's filter settles
    stride: int = 15  # frames from window to window
    horizons: tuple[int, ...] = (22, 60, 120)  # frames ahead: 0.75, 2 and 4 s
    near: float = 3.0  # [m] largest distance of a near pedestrian from a moving vehicle's body
    moving: float = 0.5  # [m/s] speed above which a vehicle moves
    front: float = CITR.vehicle.front  # [m] front of the body, from the tracked point
    rear: float = CITR.vehicle.rear  # [m] rear of the body, from the tracked point
    width: float = CITR.vehicle.width  # [m]

    @classmethod
    def of(cls, dataset: Dataset) -> "Protocol":
        """Return the same times [s] in this data set's frames, and its vehicle's body."""
        rate, body = dataset.frame_rate, dataset.vehicle
        pause = max(1, round(_PAUSE * rate))
        horizons = tuple(max(1, round(seconds * rate)) for seconds in _HORIZONS)
        return cls(
            frame_rate=rate,
            skip=pause,
            stride=pause,
            horizons=horizons,
            front=body.front,
            rear=body.rear,
            width=body.width,
        )

    @property
    def time_step(self) -> float:
        """The time [s] between two frames."""
        return 1.0 / self.frame_rate

    @property
    def longest(self) -> int:
        """The last frame of a window."""
        return max(self.horizons)


@dataclass(frozen=True, eq=False)
class Window:
    """The input of a predictor, and the observed positions.

    Attributes:
        clip: Index of its clip.
        frame: Frame of the clip, at which the prediction begins.
        who: Indices (n,) in the clip of the pedestrians seen at that frame.
        past: Positions and velocities (K, n, 4) [m], [m/s] at 0, 1 ... frames before, over 3 s or
            to the clip's first frame; nan where a pedestrian is not seen.
        position, velocity, destination: Arrays (n, 2) [m], [m/s], [m].
        vehicles: Vehicles (H, m, 7) at 0 ... H - 1 frames ahead, as the pedestrian model takes
            them.
        observed: Positions (H, n, 2) [m] at 1 ... H frames ahead; nan from the first frame on in
            which a pedestrian is not seen.
        distance: Observed distance (H + 1, n) [m] from centre to the nearest body of a vehicle that
            moves; inf without vehicles, and very large if none moves.
    """

    clip: int
    frame: int
    who: NDArray[np.int64]
    past: Array
    position: Array
    velocity: Array
    destination: Array
    vehicles: Array
    observed: Array
    distance: Array


def windows(clips: tuple[Clip, ...], protocol: Protocol) -> tuple[Window, ...]:
    """Return all windows of the clips in which a pedestrian is seen for the shortest horizon."""
    return tuple(w for number, clip in enumerate(clips) for w in _of_clip(number, clip, protocol))


def _of_clip(number: int, clip: Clip, protocol: Protocol) -> Iterator[Window]:
    shortest, longest = min(protocol.horizons), protocol.longest
    states = np.concatenate([clip.position, clip.velocity], axis=2)
    before = max(1, round(_PAST * protocol.frame_rate))
    bodies = vehicle_rows(clip, protocol)
    distances = distance_to_bodies(clip.position, _only_moving(bodies, protocol.moving))
    for frame in range(protocol.skip, clip.frames - shortest, protocol.stride):
        who = np.flatnonzero(clip.seen[frame])
        observed = _padded(clip.position[frame + 1 : frame + 1 + longest, who], longest)
        lost = np.isnan(observed[:, :, 0]).cumsum(axis=0) > 0
        observed[lost] = np.nan
        if np.isnan(observed[shortest - 1, :, 0]).all():
            continue
        distance = _padded(distances[frame : frame + 1 + longest, who], longest + 1, np.inf)
        held = np.minimum(np.arange(frame, frame + longest), clip.frames - 1)
        yield Window(
            clip=number,
            frame=frame,
            who=who,
            past=states[max(0, frame - before) : frame + 1, who][::-1].copy(),
            position=np.ascontiguousarray(clip.position[frame, who]),
            velocity=np.ascontiguousarray(clip.velocity[frame, who]),
            destination=clip.destination[who],
            vehicles=np.ascontiguousarray(bodies[held]),
            observed=observed,
            distance=distance,
        )


def vehicle_rows(clip: Clip, protocol: Protocol) -> Array:
    """Return the clip's vehicles (T, m, 7) as the pedestrian model takes them."""
    rows = np.empty((*clip.poses.shape[:2], 7))
    rows[:, :, :4] = clip.poses
    rows[:, :, 4:] = protocol.front, protocol.rear, protocol.width
    rows[np.isnan(rows).any(axis=2), :4] = _NOWHERE, _NOWHERE, 0.0, 0.0
    return rows


def _only_moving(rows: Array, least: float) -> Array:
    """Return the vehicles (T, m, 7), far away in frames in which they are not faster than that."""
    away = rows.copy()
    away[np.abs(rows[:, :, 3]) <= least, :2] = _NOWHERE
    return away


def distance_to_bodies(position: Array, rows: Array) -> Array:
    """Return the distance (T, n) [m] from each centre to the nearest body; 0 inside."""
    nearest = np.full(position.shape[:2], np.inf)
    for x, y, heading, _, front, rear, width in np.moveaxis(rows, 0, 2):
        forward, left = to_vehicle_frame(position, x, y, heading)
        beyond = np.maximum(forward - front[:, None], -rear[:, None] - forward)
        beside = np.abs(left) - 0.5 * width[:, None]
        distance = np.hypot(np.maximum(beyond, 0.0), np.maximum(beside, 0.0))
        nearest = np.fmin(nearest, distance)
    return nearest


def to_vehicle_frame(position: Array, x: Array, y: Array, heading: Array) -> tuple[Array, Array]:
    """Return how far (T, n) [m] positions are ahead of, and to the left of, a vehicle (T,)."""
    dx, dy = position[:, :, 0] - x[:, None], position[:, :, 1] - y[:, None]
    cos, sin = np.cos(heading)[:, None], np.sin(heading)[:, None]
    return cos * dx + sin * dy, cos * dy - sin * dx


def _padded(values: Array, length: int, fill: float = np.nan) -> Array:
    """Extend the ``values`` along the first axis to ``length`` by ``fill``."""
    out = np.full((length, *values.shape[1:]), fill)
    out[: len(values)] = values
    return out
