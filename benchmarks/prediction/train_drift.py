"""Train the predictor ``drift`` on recordings, and judge it on the site that it has not seen.

Run: python benchmarks/prediction/train_drift.py CITR=citr:FOLDER ROUNDABOUT=dut:FOLDER --out DRIFT

Each site is NAME=DATASET:FOLDER. With --out, arrays and provenance are written into that folder,
which is ``pedestrian_model/drift`` for the numbers that giveway ships. Needs scikit-learn:
pip install "giveway[training]". Two sites take some three minutes.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomlkit
from numpy.typing import NDArray
from scipy.optimize import minimize
from sklearn.ensemble import HistGradientBoostingRegressor

from giveway.recordings.intervals import ClipBootstrap
from giveway.validation import Clip, Protocol, dataset_of, read_clips
from giveway.validation.drift import numbers_of
from giveway.validation.prediction import predict_all, prediction_table, recent_velocity
from giveway.validation.protocol import windows
from pedestrian_model.drift.features import ALONG
from pedestrian_model.drift.forest import HORIZONS, LEAVES, Forest, fill_corrections, masked
from pedestrian_model.drift.trained import ARRAYS, EXACT, FILTERED, PROVENANCE, Fit

STRIDE = 0.1  # [s] between the starts of two windows for training
SMOOTHING = 1.0 / 6.0  # [s] before and after an instant, between which its velocity is exact
NEAR = 6.0  # [m] of those whose errors give the deviations
ROUNDS, RATE, LEAST = 60, 0.12, 400  # trees; shrinkage; people in a leaf
SEED = 0
CITATION = "D. Yang, L. Li, K. Redmill, Ü. Özgüner, IEEE IV 2019, arXiv 1902.00487"
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Samples:
    """People of windows; ``mine`` is the mean velocity along and across, less the present one."""

    numbers: Array  # (n, FEATURES)
    heading: Array  # (n, 2)
    speed: Array  # (n,) [m/s]
    mine: Array  # (n, 3, 2) [m/s], nan if not seen at the horizon
    recent: Array  # (n, 2) [m/s] velocity by positions less the data's, along and across
    near: Array  # (n, 3) [m] smallest distance to a moving vehicle up to the horizon
    clip: NDArray[np.int64]
    site: NDArray[np.int64]

    def only(self, mask: NDArray[np.bool_]) -> Samples:
        """Return the samples that a mask selects."""
        return Samples(*(getattr(self, name)[mask] for name in self.__dataclass_fields__))


def exact(clip: Clip) -> Clip:
    """Return the clip with the velocities that its positions have around each instant."""
    steps = max(1, round(SMOOTHING * clip.dataset.frame_rate))
    at = np.arange(clip.frames)
    first, last = np.maximum(at - steps, 0), np.minimum(at + steps, clip.frames - 1)
    moved = clip.position[last] - clip.position[first]
    velocity = moved * (clip.dataset.frame_rate / (last - first))[:, None, None]
    velocity = np.where(np.isnan(velocity), clip.velocity, velocity)
    return replace(clip, velocity=np.where(np.isnan(clip.position), np.nan, velocity))


def samples_of(sites: Sequence[tuple[Clip, ...]]) -> Samples:
    """Return the people of all windows of the sites."""
    parts: list[tuple[Array, ...]] = []
    for number, clips in enumerate(sites):
        usual = Protocol.of(clips[0].dataset)
        protocol = replace(usual, stride=max(1, round(STRIDE * usual.frame_rate)))
        steps = np.array(protocol.horizons) - 1
        for window in windows(clips, protocol):
            heading, numbers = numbers_of(window, protocol.time_step)
            c, s = np.where((heading == 0.0).all(axis=1)[:, None], (1.0, 0.0), heading).T
            time = ((steps + 1) * protocol.time_step)[:, None, None]
            off = (window.observed[steps] - window.position) / time - window.velocity
            late = recent_velocity(window, protocol.time_step) - window.velocity
            x, y = np.concatenate([off, late[None]]).transpose(2, 0, 1)
            both = np.stack([c * x + s * y, c * y - s * x], axis=2).transpose(1, 0, 2)
            away = np.minimum.accumulate(np.nan_to_num(window.distance, nan=np.inf), axis=0)
            same = np.full(len(heading), window.clip), np.full(len(heading), number)
            speed = np.hypot(*window.velocity.T)
            near = away[steps + 1].T
            parts.append((numbers, heading, speed, both[:, :3], both[:, 3], near, *same))
    return Samples(*(np.concatenate(each) for each in zip(*parts, strict=True)))  # type: ignore[arg-type]


def weights_of(site: NDArray[np.int64]) -> Array:
    """Return weights (n,) with which all sites count alike."""
    count = np.bincount(site)
    return np.asarray(len(site) / np.count_nonzero(count) / count[site])


def forest_of(samples: Samples) -> Forest:
    """Train the trees of all horizons and axes."""
    walks = samples.heading.any(axis=1)
    nodes: list[tuple[int, float, int]] = []
    roots, start = np.zeros((3, 2, ROUNDS), dtype=np.int64), np.zeros((3, 2))
    mirror = np.array([1.0, *[-1.0] * (samples.numbers.shape[1] - len(ALONG) - 1)])
    for horizon in range(len(HORIZONS)):
        used = walks & ~np.isnan(samples.mine[:, horizon, 0])
        weights = weights_of(samples.site[used])
        along, across = np.split(samples.numbers[used], [len(ALONG)], axis=1)
        target = samples.mine[used, horizon]
        both = np.concatenate([across, across * mirror])
        sides = np.concatenate([target[:, 1], -target[:, 1]])
        for axis, (x, y, w, least) in enumerate(
            ((along, target[:, 0], weights, LEAST), (both, sides, np.tile(weights, 2), 2 * LEAST))
        ):
            model = HistGradientBoostingRegressor(
                loss="absolute_error",
                max_iter=ROUNDS,
                learning_rate=RATE,
                max_leaf_nodes=LEAVES,
                min_samples_leaf=min(least, max(1, len(y) // 20)),
                early_stopping=False,
                random_state=SEED,
            ).fit(x, y, sample_weight=w)
            start[horizon, axis] = float(np.float32(model._baseline_prediction.item()))
            for number, (tree,) in enumerate(model._predictors):
                roots[horizon, axis, number] = _lay_out(tree.nodes, nodes)
    feature, value, below = zip(*nodes, strict=True)
    return Forest(
        np.array(feature, dtype=np.int64),
        np.array(value, dtype=np.float32).astype(np.float64),
        np.array(below, dtype=np.int64),
        roots,
        start,
    )


def _lay_out(tree: NDArray[np.void], nodes: list[tuple[int, float, int]]) -> int:
    """Append a tree to the nodes, the two below each node side by side; return its root."""
    root = len(nodes)
    nodes.append((-1, 0.0, 0))
    open_nodes = [(0, root)]
    while open_nodes:
        old, at = open_nodes.pop()
        node = tree[old]
        if node["is_leaf"]:
            nodes[at] = -1, float(node["value"]), 0
            continue
        below = len(nodes)
        nodes[at] = int(node["feature_idx"]), float(node["num_threshold"]), below
        nodes += [(-1, 0.0, 0)] * 2
        open_nodes += [(int(node["left"]), below), (int(node["right"]), below + 1)]
    return root


def answers(forest: Forest, samples: Samples) -> Array:
    """Return what the trees say (n, 3, 2) [m/s]."""
    out = np.empty((len(samples.speed), 3, 2))
    fill_corrections(masked(forest), samples.heading, samples.numbers, out)
    return out


def deviations(errors: Array, samples: Samples) -> Array:
    """Return the coefficients (3, 2, 2) of the likeliest deviations of errors (n, 3, 2) [m]."""
    out = np.empty((3, 2, 2))
    for horizon in range(3):
        used = ~np.isnan(errors[:, horizon, 0]) & (samples.near[:, horizon] < NEAR)
        used = used if used.any() else ~np.isnan(errors[:, horizon, 0])
        weights, speed = weights_of(samples.site[used]), samples.speed[used]
        for axis in range(2):
            error = errors[used, horizon, axis]

            def loss(
                law: Array, error: Array = error, speed: Array = speed, w: Array = weights
            ) -> float:
                a, b = np.exp(law)
                deviation = a + b * speed
                return float(
                    np.average(0.5 * (error / deviation) ** 2 + np.log(deviation), weights=w)
                )

            found = minimize(loss, np.log([0.2, 0.2]), method="Nelder-Mead")
            out[horizon, axis] = np.exp(found.x)
    return out


def fit_of(name: str, sites: Sequence[tuple[Clip, ...]]) -> Fit:
    """Train a fit on some sites.

    The deviations come from people of clips that the trees of two halves have not seen.
    """
    samples = samples_of(sites)
    half = samples.clip % 2 == 0
    said = np.empty_like(samples.mine)
    for mask in (half, ~half):
        said[mask] = answers(forest_of(samples.only(~mask)), samples.only(mask))
    time = np.array(HORIZONS)[None, :, None]
    straight = [factor * samples.recent[:, None, :] for factor in (0.0, 1.0, 0.5)]
    baseline = [deviations(time * (samples.mine - each), samples) for each in straight]
    clips = frozenset(clip.name for site in sites for clip in site)
    spread = deviations(time * (samples.mine - said), samples)
    return Fit(name, clips, forest_of(samples), spread, np.stack(baseline))


def judge(fit: Fit, clips: tuple[Clip, ...]) -> str:
    """Return the comparison with constant velocity on clips that the fit has not seen."""
    protocol = Protocol.of(clips[0].dataset)
    found = predict_all(windows(clips, protocol), fit, protocol)
    table = prediction_table(found, protocol, ClipBootstrap.of(len(clips)))
    return table.drop(columns=["ade", "baseline_ade", "clips"]).round(3).to_string(index=False)


def write(folder: Path, fits: Sequence[Fit], sites: dict[str, tuple[Clip, ...]]) -> None:
    """Write the arrays, and where they come from."""
    arrays = {}
    for fit in fits:
        for part in ("feature", "below", "roots"):
            arrays[f"{fit.name}.{part}"] = getattr(fit.forest, part).astype(np.int32)
        for part in ("value", "start"):
            arrays[f"{fit.name}.{part}"] = getattr(fit.forest, part).astype(np.float32)
        arrays[f"{fit.name}.deviation"] = fit.deviation.round(5)
        arrays[f"{fit.name}.baseline"] = fit.baseline.round(5)
    np.savez_compressed(folder / ARRAYS, allow_pickle=False, **arrays)
    told = tomlkit.document()
    told.add(tomlkit.comment("Written by benchmarks/prediction/train_drift.py"))
    told["citation"], told["seed"] = CITATION, SEED
    told["trees"] = {"rounds": ROUNDS, "rate": RATE, "leaves": LEAVES, "least": LEAST}
    told["sites"] = {name: len(clips) for name, clips in sites.items()}
    told["fits"] = {fit.name: {"clips": sorted(fit.clips)} for fit in fits}
    (folder / PROVENANCE).write_text(tomlkit.dumps(told), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sites", nargs="+", metavar="NAME=DATASET:FOLDER")
    parser.add_argument("--out", type=Path, help="folder for the arrays and their provenance")
    asked = parser.parse_args()
    sites: dict[str, tuple[Clip, ...]] = {}
    for site in asked.sites:
        name, _, place = site.partition("=")
        dataset, _, folder = place.partition(":")
        sites[name] = read_clips(Path(folder), dataset_of(dataset))
    smooth = {name: tuple(map(exact, clips)) for name, clips in sites.items()}
    fits = []
    for kind, of in ((FILTERED, sites), (EXACT, smooth)):
        fits.append(fit_of(kind, tuple(of.values())))
        for left_out in of if len(of) > 1 else ():
            rest = [clips for name, clips in of.items() if name != left_out]
            fit = fit_of(f"{kind} without {left_out}", rest)
            print(f"\n{kind} velocities, {left_out} left out\n{judge(fit, of[left_out])}")
            fits += [fit] if kind == FILTERED else []
    if asked.out is not None:
        write(asked.out, fits, sites)


if __name__ == "__main__":
    main()
