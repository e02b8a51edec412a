"""How people really move near a car.

Run: python benchmarks/bounds/worst_motion.py FOLDER --dataset citr dut [--window 0.5] [--sites]

Percentiles of the accelerations, of what these come to over some time, of speed and of turning, of
recorded people about a vehicle. They are what ``[safety] people`` rests on; docs/safety.md says
what the columns mean. Each data set is in FOLDER, or in a folder there that has its name.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy  # scipy.signal is loaded where it is first used
from numpy.typing import NDArray

from controller import SafetyParameters, WorstMotion
from controller.safety.worst_motion import RECORDED
from giveway.recordings.intervals import TAILS, ClipBootstrap
from giveway.validation import dataset_of, read_clips
from giveway.validation.clips import Clip
from giveway.validation.protocol import Protocol, distance_to_bodies, vehicle_rows

WINDOW = 0.5  # [s] of the smoothing; 0: differences of the data's own velocities
ORDER = 3  # of the polynomials
NEAR = 5.0  # [m] from a centre to a vehicle's body
MOVING = 0.3  # [m/s] of the vehicle at least
TURNING = 0.5  # [m/s] who is slower has no heading
AHEAD = (0.5, 1.0, 1.5)  # [s] over which people depart from a straight line
WITHIN = (NEAR, 10.0)  # [m] from a centre to a vehicle's body, of the people in the table of sites
REACHES = (0.25, 0.5, 1.0, 1.5, 2.0)  # [s] after which people are in the layer's reachable sets
LATE = 0.25  # [s] over which positions give a velocity without smoothing
MARGIN = SafetyParameters().margin  # [m] by which the layer keeps farther from a body
RESAMPLES = 1000  # of the clips
PERCENTILES = (95.0, 99.0, 99.9, 100.0)
Array = NDArray[np.float64]


class Track(NamedTuple):
    """One person's uninterrupted motion, smoothed."""

    position: Array  # (T, 2) [m]
    velocity: Array  # (T, 2) [m/s]
    acceleration: Array  # (T, 2) [m/s^2]
    near: NDArray[np.bool_]  # (T,) a moving vehicle is near
    towards: Array  # (T, 2) unit vectors to the nearest vehicle's tracked point
    clip: int = 0  # index of the clip
    person: int = 0  # index of the person in the clip


def tracks(clips: tuple[Clip, ...], window: float, reach: float = NEAR) -> Iterator[Track]:
    """Every person in every clip with a vehicle, once filters have settled."""
    for number, clip in enumerate(clips):
        if not clip.poses.shape[1]:
            continue
        protocol = Protocol.of(clip.dataset)
        rows = vehicle_rows(clip, protocol)
        distance = distance_to_bodies(clip.position, rows)
        to_each = clip.poses[:, None, :, :2] - clip.position[:, :, None]
        nearest = np.where(np.isnan(to_each), np.inf, to_each)
        which = np.hypot(nearest[..., 0], nearest[..., 1]).argmin(axis=2)
        frames = np.arange(clip.frames)[:, None]
        people = np.arange(len(clip.ids))
        to = to_each[frames, people, which]
        moving = np.abs(clip.poses[frames, which, 3]) > MOVING
        near = (distance < reach) & moving
        for i in people:
            for track in _smoothed(clip, i, near[:, i], to[:, i], protocol, window):
                yield track._replace(clip=number, person=int(i))


def _smoothed(
    clip: Clip, i: int, near: NDArray[np.bool_], to: Array, protocol: Protocol, window: float
) -> Iterator[Track]:
    frames = np.flatnonzero(clip.seen[:, i])[protocol.skip :]
    dt = protocol.time_step
    for run in np.split(frames, np.flatnonzero(np.diff(frames) > 1) + 1):
        width = max(2 * round(window / dt / 2.0) + 1, ORDER + 2)
        if len(run) < max(width, round(2.0 / dt)):
            continue
        position = clip.position[run, i]
        if window > 0.0:
            smooth = [
                scipy.signal.savgol_filter(position, width, ORDER, deriv=d, delta=dt, axis=0)
                for d in range(3)
            ]
            edge = slice(width // 2, len(run) - width // 2)
        else:
            velocity = clip.velocity[run, i]
            smooth = [position, velocity, np.gradient(velocity, dt, axis=0)]
            edge = slice(1, len(run) - 1)
        length = np.maximum(np.hypot(to[run, 0], to[run, 1]), 1e-9)[:, None]
        yield Track(*(each[edge] for each in (*smooth, near[run], to[run] / length)))


def departures(found: list[Track], ahead: float, dt: float) -> Array:
    """[m/s^2] the constant acceleration that leaves a straight line as far within ``ahead``."""
    steps = round(ahead / dt)
    ahead = steps * dt
    parts = []
    for track in found:
        off = track.position[steps:] - track.position[:-steps] - ahead * track.velocity[:-steps]
        size = 2.0 * np.hypot(off[:, 0], off[:, 1]) / ahead**2
        parts.append(size[track.near[:-steps]])
    return np.concatenate(parts)


def quantities(clips: tuple[Clip, ...], window: float) -> dict[str, Array]:
    """Values of all people near a moving vehicle, by the heads of the table's rows."""
    found = [track for track in tracks(clips, window) if track.near.any()]
    if not found:
        raise SystemExit(f"{clips[0].dataset.name}: nobody within {NEAR:g} m of a moving vehicle")
    dt = Protocol.of(clips[0].dataset).time_step
    v, a, towards = (
        np.concatenate([getattr(track, name)[track.near] for track in found])
        for name in ("velocity", "acceleration", "towards")
    )
    speed = np.hypot(*v.T)
    fast, cross = speed > TURNING, v[:, 0] * a[:, 1] - v[:, 1] * a[:, 0]
    leaves = {
        f"acceleration that leaves a straight line as far within {ahead:g} s [m/s²]": departures(
            found, ahead, dt
        )
        for ahead in AHEAD
    }
    return {
        "acceleration [m/s²]": np.hypot(*a.T),
        "its part towards the vehicle [m/s²]": np.einsum("ij,ij->i", a, towards),
        **leaves,
        "speed [m/s]": speed,
        f"turning above {TURNING:g} m/s [°/s]": np.degrees(np.abs(cross[fast]) / speed[fast] ** 2),
    }


def table(measured: dict[str, dict[str, Array]]) -> None:
    """Print the percentiles as Markdown: a row for each quantity, columns for each data set."""
    heads = [f"{name} {p:g} %" for name in measured for p in PERCENTILES]
    print(f"| | {' | '.join(heads)} |\n|{'---|' * (1 + len(heads))}")
    for row in next(iter(measured.values())):
        numbers = np.concatenate([np.percentile(of[row], PERCENTILES) for of in measured.values()])
        digits = 0 if row.startswith("turning") else 2
        print(f"| {row} | {' | '.join(f'{number:.{digits}f}' for number in numbers)} |")


class Needed(NamedTuple):
    """The least bounds with which instants are within the layer's reachable sets."""

    acceleration: Array  # (N,) [m/s^2]
    speed: Array  # (N,) [m/s]
    clip: NDArray[np.int64]  # (N,) index of the clip
    person: NDArray[np.int64]  # (N,) index of the person in the clip


def needed(found: list[Track], dt: float, late: bool = False) -> Needed:
    """Return the least bounds of each instant near a vehicle; those of the later places count.

    Args:
        found: Tracks of the people.
        dt: Time step [s].
        late: True if the velocity is that of the positions over the last 0.25 s.
    """
    parts: list[tuple[Array, Array, Array, Array]] = []
    for track in found:
        back = max(1, round(LATE / dt)) if late else 0
        first, last = back, len(track.position) - max(1, round(REACHES[0] / dt))
        if last <= first:
            continue
        here, near = track.position[first:last], track.near[first:last]
        velocity = track.velocity[first:last]
        if late:
            velocity = (here - track.position[: last - first]) / (back * dt)
        acceleration, speed = np.zeros(len(here)), np.zeros(len(here))
        for reach in REACHES:
            steps = max(1, round(reach / dt))
            t, there = steps * dt, track.position[first + steps :][: len(here)]
            n = len(there)
            off, way = there - here[:n] - t * velocity[:n], there - here[:n]
            beyond = np.maximum(np.hypot(*off.T) - MARGIN, 0.0)
            acceleration[:n] = np.maximum(acceleration[:n], 2.0 * beyond / t**2)
            speed[:n] = np.maximum(speed[:n], np.maximum(np.hypot(*way.T) - MARGIN, 0.0) / t)
        which = np.full(near.sum(), track.clip), np.full(near.sum(), track.person)
        parts.append((acceleration[near], speed[near], *which))
    return Needed(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def quantile(values: Array, clip: NDArray[np.int64], share: float) -> tuple[float, float, float]:
    """Return a quantile of the values, and its interval: clips are resampled.

    Args:
        values: Values (N,).
        clip: Clip (N,) of each value.
        share: Share of the values below the quantile.
    """
    clips, of = np.unique(clip, return_inverse=True)
    order = np.argsort(values)
    draws = ClipBootstrap.of(len(clips), resamples=RESAMPLES).weights
    drawn = []
    for weights in (np.ones(len(clips)), *draws):
        below = np.cumsum(weights[of[order]])
        drawn.append(values[order[np.searchsorted(below, share * below[-1])]])
    return float(drawn[0]), *np.quantile(drawn[1:], TAILS).tolist()


def site_of(clip: Clip) -> str:
    """Return the site of a clip: its data set, and at DUT its name without the number."""
    name = clip.name.rstrip("0123456789").rstrip("_")
    return f"DUT {name}" if clip.dataset.name == "DUT" else clip.dataset.name


def sites(clips: Sequence[Clip]) -> None:
    """Print the table of sites of all data sets."""
    bounds = [RECORDED[name] for name in ("recorded-99.9", "responsible")]
    keep = [f"people, instants [%] within {b.acceleration:g}, {b.speed:g}" for b in bounds]
    heads = [
        "site",
        "within [m]",
        "velocity",
        "clips",
        "people",
        "instants",
        "a 99 %",
        "a 99.9 %",
        "a 100 %",
    ]
    heads += ["v 99.9 %", *keep]
    print(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    for site in sorted({site_of(clip) for clip in clips}):
        its = tuple(clip for clip in clips if site_of(clip) == site)
        dt = Protocol.of(its[0].dataset).time_step
        smooth, raw = "smoothed over 0.5 s", list(tracks(its, 0.0, WITHIN[-1]))
        rows = [(w, smooth, needed(list(tracks(its, 0.5, w)), dt)) for w in WITHIN]
        rows.append((WITHIN[-1], "positions over 0.25 s", needed(raw, dt, late=True)))
        rows.append((WITHIN[-1], "the file's", needed(raw, dt)))
        for within, velocity, found in rows:
            row = [site, f"{within:g}", velocity]
            print(f"| {' | '.join([*row, *cells(found, bounds)])} |")


def cells(found: Needed, bounds: Sequence[WorstMotion]) -> list[str]:
    """Return the cells of a row of the table of sites.

    Args:
        found: Least bounds of all instants.
        bounds: Bounds of which the row says who keeps to them.
    """
    clips, people = np.unique(found.clip), np.unique([found.clip, found.person], axis=1).T
    said = [str(len(each)) for each in (clips, people, found.clip)]
    for values, share in (
        (found.acceleration, 0.99),
        (found.acceleration, 0.999),
        (found.acceleration, 1.0),
        (found.speed, 0.999),
    ):
        middle, low, high = quantile(values, found.clip, share)
        said.append(f"{middle:.2f} [{low:.2f}, {high:.2f}]" if share < 1 else f"{middle:.2f}")
    for bound in bounds:
        within = (found.acceleration <= bound.acceleration) & (found.speed <= bound.speed)
        beyond = np.unique([found.clip[~within], found.person[~within]], axis=1).shape[1]
        said.append(f"{100 * (1 - beyond / len(people)):.1f}, {100 * within.mean():.2f}")
    return said


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--dataset", required=True, nargs="+", help="citr, dut, or a description (TOML)"
    )
    parser.add_argument("--window", type=float, default=WINDOW, help="smoothing [s], or 0")
    parser.add_argument("--sites", action="store_true", help="print the table of sites")
    options = parser.parse_args()
    found = {}
    for name in options.dataset:
        own = options.folder / name
        dataset = dataset_of(name)
        found[dataset.name] = read_clips(own if own.is_dir() else options.folder, dataset)
    if options.sites:
        sites([clip for clips in found.values() for clip in clips])
        return
    table({name: quantities(clips, options.window) for name, clips in found.items()})


if __name__ == "__main__":
    main()
