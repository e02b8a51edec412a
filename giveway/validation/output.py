"""The files of ``giveway validate``: tables and pictures."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from giveway.figures.validation_figures import (
    Body,
    Curve,
    growth_figure,
    places_figure,
    tracks_figure,
)
from giveway.validation.evaluation import EVERYWHERE, NEAR
from giveway.validation.files import names_of, write_files
from giveway.validation.predictors import CV, NO_VEHICLE, OWN_PACE, VCI, predictors
from giveway.validation.protocol import Window
from giveway.validation.validating import Validation
from pedestrian_model import VciParameters

TABLES = ("errors.csv", "contacts.csv", "prediction.csv")
PICTURES = ("growth", "tracks", "places")
FILES = names_of(TABLES, PICTURES)
"""Names of all files that ``giveway validate`` writes into its folder."""


def write_validation(found: Validation, parameters: VciParameters, folder: Path) -> None:
    """Write the tables, and each picture as PNG and SVG.

    Raises:
        ResultsError: a file cannot be written.
    """
    tables = found.errors, found.contacts, found.prediction
    pictures = _pictures(found, parameters)
    write_files(
        folder,
        dict(zip(TABLES, tables, strict=True)),
        dict(zip(PICTURES, pictures, strict=True)),
    )


def _pictures(found: Validation, parameters: VciParameters) -> tuple[Figure, Figure, Figure]:
    time = np.arange(1, found.protocol.longest + 1) / found.protocol.frame_rate
    people = f"{len(found.clips)} clips, {found.pedestrians} pedestrians"
    return (
        growth_figure(time, _curves(found), f"Prediction error, {people}"),
        _tracks(found, parameters),
        _places(found),
    )


def _curves(found: Validation) -> dict[str, dict[str, Curve]]:
    """Return the curves of all people, and of those near the vehicle in the longest horizon."""
    rows = found.found
    near = rows.near[:, int(np.argmax(rows.horizons))]
    groups = {EVERYWHERE: np.ones(len(near), dtype=bool), NEAR: near}
    titles = {
        EVERYWHERE: "everybody",
        NEAR: f"within {found.protocol.near:g} m of a moving vehicle",
    }
    return {
        titles[group]: {name: _curve(found, p, mask) for p, name in enumerate(rows.names)}
        for group, mask in groups.items()
        if mask.any()
    }


def _curve(found: Validation, predictor: int, mask: NDArray[np.bool_]) -> Curve:
    rows = found.found
    points = []
    for error in rows.error[predictor].T:
        total, count = rows.per_clip(error, mask & ~np.isnan(error))
        mean = total.sum() / count.sum() if count.any() else np.nan
        points.append((mean, *found.draws.interval(total, count)))
    mean, low, high = np.array(points).T
    return Curve(mean, low, high)


def _tracks(found: Validation, parameters: VciParameters) -> Figure:
    """Draw the window in which most pedestrians come near a vehicle."""
    window = max(found.cut, key=lambda w: _interest(w, found.protocol.near))
    steps, longest = found.protocol.time_step, found.protocol.longest
    by = predictors(parameters, steps, longest)
    shown = [name for name in (VCI, NO_VEHICLE, CV) if name in by]
    start = window.position[None]
    ahead = {name: np.concatenate([start, by[name](window)]) for name in shown}
    clip = found.clips[window.clip]
    rows = window.vehicles[[0, longest // 2, longest - 1], :1].reshape(-1, 7)  # none: no vehicle
    bodies = [Body(x, y, heading, *body) for x, y, heading, _, *body in rows]
    return tracks_figure(
        np.concatenate([start, window.observed]),
        ahead,
        bodies,
        f"{clip.name}, {longest * steps:.1f} s from frame {clip.first_frame + window.frame}",
    )


def _interest(window: Window, near: float) -> tuple[int, int, float]:
    """Rate a window: pedestrians near the vehicle, those seen to the end, and least distance."""
    distance = np.nan_to_num(window.distance, nan=np.inf)
    whole = int((~np.isnan(window.observed[-1, :, 0])).sum())
    return int((distance.min(axis=0) <= near).sum()), whole, -float(distance.min())


def _places(found: Validation) -> Figure:
    """Draw the places for the middle horizon, which is 2 s of 0.75, 2 and 4 s."""
    rows, protocol = found.found, found.protocol
    k = len(rows.horizons) // 2
    errors = {name: rows.fde[rows.names.index(name), :, k] for name in (VCI, OWN_PACE, CV)}
    body = Body(0.0, 0.0, 0.0, protocol.front, protocol.rear, protocol.width)
    seconds = rows.horizons[k] * protocol.time_step
    title = f"Where errors are made: {seconds:.2g} s ahead, by place at the start"
    return places_figure(rows.place, errors, body, title)
