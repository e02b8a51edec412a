"""The errors of predictions: one row per window, pedestrian and horizon."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.recordings.intervals import ClipBootstrap
from giveway.validation.predictors import CV, GOAL_CV, TrackPredictor
from giveway.validation.protocol import Protocol, Window, to_vehicle_frame

EVERYWHERE = "all"
NEAR = "near"
METRICS = ("ADE", "FDE")


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The errors of each predictor; a row is a pedestrian of a window.

    Attributes:
        names: Names (P,) of the predictors.
        horizons: Horizons (K,) [frames].
        clip: Clip (R,) of each row.
        valid: Flags (R, K): the pedestrian is seen for that long.
        near: Flags (R, K): the pedestrian comes near a moving vehicle within that time.
        ade, fde: Errors (P, R, K) [m]; nan where not valid.
        error: Displacement (P, R, H) [m] at each frame; nan where not seen.
        place: Place (R, 2) [m] at the start, ahead and to the left of the vehicle; nan without one.
        clips: Number C of clips.
    """

    names: tuple[str, ...]
    horizons: tuple[int, ...]
    clip: NDArray[np.int64]
    valid: NDArray[np.bool_]
    near: NDArray[np.bool_]
    ade: Array
    fde: Array
    error: Array
    place: Array
    clips: int

    def chosen(self, subset: str, horizon: int) -> NDArray[np.bool_]:
        """Return flags (R,) of a subset at the horizon with this number."""
        everybody = self.valid[:, horizon]
        return everybody if subset == EVERYWHERE else everybody & self.near[:, horizon]

    def per_clip(self, values: Array, mask: NDArray[np.bool_]) -> tuple[Array, Array]:
        """Return sum and number (C,) of the ``values`` (R,) in each clip where ``mask`` holds."""
        clip = self.clip[mask]
        total = np.bincount(clip, values[mask], self.clips).astype(np.float64)
        return total, np.bincount(clip, minlength=self.clips).astype(np.float64)


def evaluate(
    cut: Sequence[Window],
    by: Mapping[str, TrackPredictor],
    protocol: Protocol,
    clips: int,
    advance: Callable[[], None] = lambda: None,
) -> Evaluation:
    """Predict every window by each predictor, and compare with the data.

    Args:
        cut: Windows, at least one.
        by: Predictors by name.
        protocol: Protocol by which the windows were cut.
        clips: Number of clips, including those without a window.
        advance: Function that is called after each window.
    """
    steps = np.array(protocol.horizons) - 1
    error, near, place = [], [], []
    for window in cut:
        error.append(np.stack([displacement(predict(window), window) for predict in by.values()]))
        closest = np.minimum.accumulate(np.nan_to_num(window.distance, nan=np.inf), axis=0)
        near.append((closest[steps + 1] <= protocol.near).T)
        place.append(_place(window))
        advance()
    errors = np.concatenate(error, axis=2).transpose(0, 2, 1)
    with np.errstate(invalid="ignore"):
        means = np.cumsum(errors, axis=2)[:, :, steps] / (steps + 1.0)
    return Evaluation(
        names=tuple(by),
        horizons=protocol.horizons,
        clip=np.repeat([w.clip for w in cut], [len(w.who) for w in cut]).astype(np.int64),
        valid=~np.isnan(errors[0][:, steps]),
        near=np.concatenate(near),
        ade=means,
        fde=errors[:, :, steps],
        error=errors,
        place=np.concatenate(place),
        clips=clips,
    )


def displacement(predicted: Array, window: Window) -> Array:
    """Return the distance (H, n) [m] of predicted and observed positions; nan if not seen."""
    apart = predicted - window.observed
    length: Array = np.hypot(apart[:, :, 0], apart[:, :, 1])
    return length


def error_table(found: Evaluation, protocol: Protocol, draws: ClipBootstrap) -> pd.DataFrame:
    """Return means, their intervals, and paired differences from the two simplest predictors.

    These are constant velocity and the walk straight to the destination.

    There is one row per subset, horizon [s], metric [m] and predictor. ``count`` is the number of
    pedestrians in windows, ``clips`` the number of clips with such pedestrians.
    """
    rows: list[dict[str, Any]] = []
    for subset in (EVERYWHERE, NEAR):
        for k, horizon in enumerate(found.horizons):
            mask = found.chosen(subset, k)
            for metric, values in zip(METRICS, (found.ade, found.fde), strict=True):
                sums = {
                    name: found.per_clip(values[p, :, k], mask)
                    for p, name in enumerate(found.names)
                }
                for name in found.names:
                    head = {"subset": subset, "horizon": round(horizon * protocol.time_step, 2)}
                    head |= {"metric": metric, "predictor": name}
                    rows.append(head | _numbers(sums, name, draws))
    return pd.DataFrame(rows)


def _numbers(
    sums: Mapping[str, tuple[Array, Array]], name: str, draws: ClipBootstrap
) -> dict[str, Any]:
    total, count = sums[name]
    people = count.sum()
    low, high = draws.interval(total, count)
    numbers = {"mean": _ratio(total.sum(), people), "low": low, "high": high}
    for other, column in ((CV, "against_cv"), (GOAL_CV, "against_goal_cv")):
        if other in sums:
            apart = total - sums[other][0]
            low, high = draws.interval(apart, count)
            numbers |= {column: _ratio(apart.sum(), people)}
            numbers |= {f"{column}_low": low, f"{column}_high": high}
    return numbers | {"count": int(people), "clips": int(np.count_nonzero(count))}


def _ratio(total: float, count: float) -> float:
    return float(total / count) if count else float("nan")


def _place(window: Window) -> Array:
    """Return the places (n, 2) [m] at the start, ahead and to the left of the first vehicle."""
    if not window.vehicles.shape[1]:
        return np.full((len(window.who), 2), np.nan)
    start = to_vehicle_frame(window.position[None], *window.vehicles[:1, 0, :3].T)
    place: Array = np.stack(start, axis=2)[0]
    return place
