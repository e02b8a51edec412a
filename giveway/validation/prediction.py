"""The comparison of ``drift`` with constant velocity: errors, likelihoods and calibration.

A predictor's answer is a normal distribution about its position, with standard deviations along and
across the heading. The baseline is, at each horizon, the best of constant velocity by the data's
velocity, by the positions of the last quarter second, and by the mean of both: the velocities of
recordings are filtered, and lag.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from giveway.geometry.kernel import Array
from giveway.recordings.intervals import ClipBootstrap
from giveway.validation.drift import DriftTracks, numbers_of
from giveway.validation.evaluation import EVERYWHERE, NEAR
from giveway.validation.protocol import Protocol, Window
from pedestrian_model.drift.motion import spread
from pedestrian_model.drift.trained import Fit

DRIFT: Final = "drift"
BASELINES: Final = ("CV", "CV by positions", "CV by both")
SHARES: Final = (0.5, 0.95)  # Probabilities whose regions are compared with the data
_RECENT = 0.25  # Time [s] over which positions give a velocity


@dataclass(frozen=True, eq=False)
class Predicted:
    """The predictions of drift and the baselines; a row is a pedestrian of a window.

    Attributes:
        clip: Clip (R,) of each row.
        near: Flags (R, K): the pedestrian comes near a moving vehicle within that time.
        error: Errors (4, R, K, 2) [m] along and across the heading, drift first; nan if not seen.
        deviation: Predicted standard deviations (4, R, K, 2) [m].
        ade: Mean displacements (4, R, K) [m] up to each horizon.
    """

    clip: NDArray[np.int64]
    near: NDArray[np.bool_]
    error: Array
    deviation: Array
    ade: Array

    @property
    def fde(self) -> Array:
        """Final displacements (4, R, K) [m]."""
        return np.asarray(np.hypot(self.error[..., 0], self.error[..., 1]))

    @property
    def nll(self) -> Array:
        """Negative log likelihoods (4, R, K) of the observed positions."""
        scaled = (self.error / self.deviation) ** 2
        each = 0.5 * scaled + np.log(self.deviation) + 0.5 * np.log(2.0 * np.pi)
        return np.asarray(each.sum(axis=3))

    def inside(self, share: float) -> Array:
        """Flags (4, R, K), 0 or 1, of positions in the ellipse that should hold this share."""
        scaled = ((self.error / self.deviation) ** 2).sum(axis=3)
        return np.where(np.isnan(scaled), np.nan, scaled <= -2.0 * np.log1p(-share))


def predict_all(
    cut: Sequence[Window],
    fit: Fit,
    protocol: Protocol,
    advance: Callable[[], None] = lambda: None,
) -> Predicted:
    """Predict every window by ``drift`` and by the baselines.

    Args:
        cut: Windows, at least one.
        fit: Fit of drift, which should not have seen their clips.
        protocol: Protocol by which they were cut.
        advance: Function that is called after each window.
    """
    tracks = DriftTracks(fit, protocol.time_step, protocol.longest)
    parts = []
    for window in cut:
        parts.append(_of_window(window, tracks, fit, protocol))
        advance()
    near, error, deviation, ade = (
        np.concatenate(each, axis=axis)
        for each, axis in zip(zip(*parts, strict=True), (0, 1, 1, 1), strict=True)
    )
    clip = np.repeat([w.clip for w in cut], [len(w.who) for w in cut]).astype(np.int64)
    return Predicted(clip, near, error, deviation, ade)


def _of_window(
    window: Window, tracks: DriftTracks, fit: Fit, protocol: Protocol
) -> tuple[NDArray[np.bool_], Array, Array, Array]:
    """Return nearness, errors, deviations and mean displacements of one window."""
    steps = np.array(protocol.horizons) - 1
    time = protocol.time_step * np.arange(1.0, protocol.longest + 1.0)
    recent = recent_velocity(window, protocol.time_step)
    velocities = (window.velocity, recent, 0.5 * (window.velocity + recent))
    straight = [window.position + time[:, None, None] * v for v in velocities]
    off = np.stack([window.observed - track for track in (tracks(window), *straight)])
    away = np.hypot(off[..., 0], off[..., 1])
    ade = (np.cumsum(away, axis=1)[:, steps] / (steps + 1.0)[None, :, None]).transpose(0, 2, 1)
    heading, _ = numbers_of(window, protocol.time_step)
    c, s = np.where((heading == 0.0).all(axis=1)[:, None], (1.0, 0.0), heading).T
    x, y = np.moveaxis(off[:, steps], 3, 0)
    error = np.stack([c * x + s * y, c * y - s * x], axis=3).transpose(0, 2, 1, 3)
    speed = np.hypot(window.velocity[:, 0], window.velocity[:, 1])
    laws = (fit.deviation, *fit.baseline)
    deviation = np.stack([spread(law, speed, time[steps]) for law in laws]).transpose(0, 2, 1, 3)
    closest = np.minimum.accumulate(np.nan_to_num(window.distance, nan=np.inf), axis=0)
    return (closest[steps + 1] <= protocol.near).T, error, deviation, ade


def recent_velocity(window: Window, time_step: float) -> Array:
    """Return the mean velocities (n, 2) [m/s] of the last quarter second, by positions.

    Of a person who has not been seen before, it is the data's velocity.
    """
    past = window.past[: max(1, round(_RECENT / time_step)) + 1]
    unseen = np.isnan(past[:, :, 0])
    known = np.where(unseen.any(axis=0), unseen.argmax(axis=0), len(past)) - 1
    before = past[known, np.arange(past.shape[1]), :2]
    time = np.maximum(known, 1)[:, None] * time_step
    moved = (window.position - before) / time
    return np.where(known[:, None] > 0, moved, window.velocity)


def prediction_table(found: Predicted, protocol: Protocol, draws: ClipBootstrap) -> pd.DataFrame:
    """Return how drift compares with the best constant velocity, by subset and horizon.

    ``change`` is the relative difference of the FDE, drift over baseline - 1, with its interval;
    ``nll_change`` the difference of the likelihoods. Negative is better.
    """
    rows: list[dict[str, Any]] = []
    fde, nll = found.fde, found.nll
    for subset in (EVERYWHERE, NEAR):
        for k, horizon in enumerate(protocol.horizons):
            mask = ~np.isnan(fde[0, :, k])
            mask &= found.near[:, k] | (subset == EVERYWHERE)
            if not mask.any():
                continue
            best = 1 + int(np.argmin(fde[1:, mask, k].mean(axis=1)))
            head = {"subset": subset, "horizon": round(horizon * protocol.time_step, 2)}
            head |= {"count": int(mask.sum()), "clips": len(np.unique(found.clip[mask]))}
            row: dict[str, Any] = head | {"baseline": BASELINES[best - 1]}
            for name, values in (("ade", found.ade), ("fde", fde), ("nll", nll)):
                row |= {name: values[0, mask, k].mean()}
                row |= {f"baseline_{name}": values[best, mask, k].mean()}
            ours, theirs, number = (
                np.bincount(found.clip[mask], weights, draws.weights.shape[1]).astype(np.float64)
                for weights in (fde[0, mask, k], fde[best, mask, k], np.ones(int(mask.sum())))
            )
            gained = np.bincount(
                found.clip[mask], (nll[0] - nll[best])[mask, k], draws.weights.shape[1]
            )
            low, high = draws.interval(ours - theirs, theirs)
            theirs_mean = row["baseline_fde"]
            row |= {"change": row["fde"] / theirs_mean - 1.0 if theirs_mean else np.nan}
            row |= {"change_low": low, "change_high": high}
            low, high = draws.interval(gained.astype(np.float64), number)
            row |= {"nll_change": row["nll"] - row["baseline_nll"]}
            row |= {"nll_change_low": low, "nll_change_high": high}
            for share in SHARES:
                inside = found.inside(share)
                row |= {f"inside_{share:g}": inside[0, mask, k].mean()}
                row |= {f"baseline_inside_{share:g}": inside[best, mask, k].mean()}
            rows.append(row)
    return pd.DataFrame(rows)
