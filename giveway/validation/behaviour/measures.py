"""The measures of how people behave near moving vehicles, for recorded and simulated people."""

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from giveway.geometry.kernel import Array
from giveway.metrics.close_passes import CLOSE, CLOSE_SPEED, NEAR
from giveway.metrics.encroachment import PERSON
from giveway.recordings import Recording, Tracks
from giveway.recordings.drives import drive_of, encroachments, nearness

MOVING = 0.5
"""Speed [m/s] above which a vehicle moves."""
BESIDE = 3.0
"""Clearance [m] up to which speeds and accelerations of people count."""
INTERVAL = 0.2
"""Time [s] between two samples, and over which velocities are differenced."""
STRIDE = 0.5
"""Time [s] between the positions whose second difference is an acceleration. The filters of files
lag behind in the velocities, and over a shorter time the errors of positions are felt."""
LAG = 0.5
"""Time [s] of the autocorrelation of a person's speed."""


_LAGS = 3  # Number of lags for which a person must be seen
_STEADY = 1e-8  # Variance [m^2/s^2] of a speed that does not change


class Measure(NamedTuple):
    """One distribution that is compared.

    Attributes:
        name: Name, also of the column in ``people.csv``.
        unit: Unit.
        title: What it is, in words.
    """

    name: str
    unit: str
    title: str


SPEED: Final = Measure("speed", "m/s", "speed")
CLEARANCE: Final = Measure("clearance", "m", "smallest clearance")
EVASION: Final = Measure("evasion", "m", "lateral evasion")
ENCROACHMENT: Final = Measure("post_encroachment_time", "s", "post-encroachment time")
NEIGHBOUR: Final = Measure("neighbour", "m", "nearest person")
ACCELERATION: Final = Measure("acceleration", "m/s^2", "acceleration")
MEASURES: Final = (SPEED, CLEARANCE, EVASION, ENCROACHMENT, NEIGHBOUR, ACCELERATION)
"""The measures whose mean ratio says how like recorded people the simulated ones are."""
CHANGE: Final = Measure("change", "m/s^2", "acceleration, 0.2 s")
PERSISTENCE: Final = Measure("persistence", "-", "autocorrelation of speed")
SHORT_TERM: Final = (CHANGE, PERSISTENCE)
"""The measures that a model may buy with white noise: they are told apart."""
ALL: Final = MEASURES + SHORT_TERM


@dataclass(frozen=True, eq=False)
class Samples:
    """The samples of one measure.

    Attributes:
        value: Values (S,).
        person: Index (S,) of each value's person.
    """

    value: Array
    person: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Behaviour:
    """The behaviour of the n people of a recording, or of several.

    Attributes:
        samples: Samples of each measure, by its name; only of people near a moving vehicle.
        contact: Flags (n,) of people who touch a vehicle.
        pairs: Number (n,) of moving vehicles that each person is near.
        close: Number (n,) of these that pass the person closely.
    """

    samples: dict[str, Samples]
    contact: NDArray[np.bool_]
    pairs: NDArray[np.int64]
    close: NDArray[np.int64]

    def of_each(self, measure: Measure) -> Array:
        """Return the mean (n,) of each person's samples, nan without any."""
        samples, people = self.samples[measure.name], len(self.contact)
        count = np.bincount(samples.person, minlength=people)
        total = np.bincount(samples.person, samples.value, minlength=people)
        mean: Array = np.divide(total, count, out=np.full(people, np.nan), where=count > 0)
        return mean


def near_vehicles(recording: Recording) -> NDArray[np.bool_]:
    """Return whether each of n people is within 4 m of each of m moving vehicles, (n, m)."""
    people, vehicles = len(recording.people.ids), len(recording.vehicles.ids)
    near = np.zeros((people, vehicles), dtype=bool)
    for number in range(vehicles):
        found = nearness(drive_of(recording, number))
        moving = np.where(found.speed > MOVING, found.clearance, np.inf)
        near[:, number] = found.smallest(moving, people) <= NEAR
    return near


def behaviour_of(recording: Recording, near: NDArray[np.bool_]) -> Behaviour:
    """Measure people near moving vehicles.

    Args:
        recording: Recording, or one with simulated people.
        near: Pairs (n, m) of people and vehicles that count, see :func:`near_vehicles`.
    """
    people = recording.people
    count = len(people.ids)
    beside = np.full(len(people.track), np.inf)  # clearance to the nearest moving vehicle
    least, touching = np.full(count, np.inf), np.full(count, np.inf)
    close = np.zeros(count, dtype=np.int64)
    signed = np.full(count, np.nan)
    for number in range(len(recording.vehicles.ids)):
        drive = drive_of(recording, number)
        found = nearness(drive)
        moving = np.where(found.speed > MOVING, found.clearance, np.inf)
        rows = _between(people, drive.first, drive.first + drive.track.time.size - 1)
        beside[rows] = np.minimum(beside[rows], moving)
        least = np.minimum(least, found.smallest(moving, count))
        touching = np.minimum(touching, found.smallest(found.clearance, count))
        fast = np.where(found.speed > CLOSE_SPEED, found.clearance, np.inf)
        close += near[:, number] & (found.smallest(fast, count) < CLOSE)
        if near[:, number].any():
            time, first = encroachments(drive, near[:, number])
            mine = np.where(first == PERSON, time, -time) + 0.0
            shorter = near[:, number] & ~np.isnan(mine)
            shorter &= ~(np.abs(signed) <= np.abs(mine))
            signed[shorter] = mine[shorter]
    counted: NDArray[np.bool_] = near.sum(axis=1) > 0
    every = max(1, round(INTERVAL * recording.frame_rate))
    sampled = counted[people.track] & (people.frame % every == 0)
    beside_one = sampled & (beside <= BESIDE)
    rate = recording.frame_rate
    apart = _nearest(people, sampled)
    samples = {
        SPEED.name: _rows(people, people.speed, beside_one),
        CLEARANCE.name: _each(np.minimum(least, NEAR), counted),
        EVASION.name: _each(_evasions(people), counted),
        ENCROACHMENT.name: _each(signed, counted),
        NEIGHBOUR.name: _rows(people, apart, sampled),
        ACCELERATION.name: _rows(people, _accelerations(people, rate), beside_one),
        CHANGE.name: _rows(people, _changes(people, every, rate), beside_one),
        PERSISTENCE.name: _each(_autocorrelations(people, rate), counted),
    }
    return Behaviour(samples, touching < 0.0, near.sum(axis=1), close)


def together(parts: list[Behaviour]) -> Behaviour:
    """Return the behaviour of all people of several recordings, numbered in order."""
    offsets = np.cumsum([0, *(len(part.contact) for part in parts)]).tolist()
    samples = {}
    for measure in ALL:
        found = [part.samples[measure.name] for part in parts]
        samples[measure.name] = Samples(
            np.concatenate([each.value for each in found]),
            np.concatenate(
                [each.person + offset for each, offset in zip(found, offsets[:-1], strict=True)]
            ),
        )
    return Behaviour(
        samples,
        np.concatenate([part.contact for part in parts]),
        np.concatenate([part.pairs for part in parts]),
        np.concatenate([part.close for part in parts]),
    )


def _between(people: Tracks, first: int, last: int) -> NDArray[np.bool_]:
    """Return the rows of people between two instants, both included."""
    return (people.frame >= first) & (people.frame <= last)


def _rows(people: Tracks, values: Array, rows: NDArray[np.bool_]) -> Samples:
    rows = rows & np.isfinite(values)
    return Samples(values[rows], people.track[rows])


def _each(values: Array, counted: NDArray[np.bool_]) -> Samples:
    who = np.flatnonzero(counted & ~np.isnan(values))
    return Samples(values[who], who)


def _accelerations(people: Tracks, frame_rate: float) -> Array:
    """Return the second difference (R,) [m/s^2] of each row's positions over ``STRIDE``."""
    frames = max(1, round(STRIDE * frame_rate))
    found = np.full(len(people.track), np.nan)
    place = people.position
    if len(found) > 2 * frames:
        turn = place[2 * frames :] - 2.0 * place[frames:-frames] + place[: -2 * frames]
        size = np.hypot(turn[:, 0], turn[:, 1]) * (frame_rate / frames) ** 2
        found[frames:-frames] = np.where(_apart(people, 2 * frames), size, np.nan)
    return found


def _changes(people: Tracks, frames: int, frame_rate: float) -> Array:
    """Return the change (R,) [m/s^2] of each row's velocity from a row some frames before."""
    found = np.full(len(people.track), np.nan)
    if len(found) > frames:
        change = people.velocity[frames:] - people.velocity[:-frames]
        size = np.hypot(change[:, 0], change[:, 1]) * frame_rate / frames
        found[frames:] = np.where(_apart(people, frames), size, np.nan)
    return found


def _autocorrelations(people: Tracks, frame_rate: float) -> Array:
    """Return the autocorrelation (n,) of each person's speed at ``LAG``, nan if seen briefly."""
    lag = max(1, round(LAG * frame_rate))
    found = np.full(len(people.ids), np.nan)
    for track, (first, end) in enumerate(zip(people.bounds[:-1], people.bounds[1:], strict=True)):
        if end - first >= _LAGS * lag:
            speed = people.speed[first:end] - people.speed[first:end].mean()
            spread = float(np.mean(speed * speed))
            if spread > _STEADY:
                found[track] = np.mean(speed[lag:] * speed[:-lag]) / spread
    return found


def _apart(people: Tracks, frames: int) -> NDArray[np.bool_]:
    """Return whether each row and the one ``frames`` rows later are so many frames of one track."""
    same = people.track[frames:] == people.track[:-frames]
    same &= people.frame[frames:] - people.frame[:-frames] == frames
    return np.asarray(same, dtype=np.bool_)


def _evasions(people: Tracks) -> Array:
    """Return each person's largest distance (n,) [m] from the line of the first and last place."""
    bounds = people.bounds
    first, last = people.position[bounds[:-1]], people.position[bounds[1:] - 1]
    course = last - first
    length = np.hypot(course[:, 0], course[:, 1])
    along = course / np.where(length > 0.0, length, 1.0)[:, None]
    away = people.position - first[people.track]
    ahead = along[people.track]
    beside = np.abs(ahead[:, 0] * away[:, 1] - ahead[:, 1] * away[:, 0])
    largest = np.zeros(len(people.ids))
    np.maximum.at(largest, people.track, beside)
    largest[length == 0.0] = np.nan
    return largest


def _nearest(people: Tracks, rows: NDArray[np.bool_]) -> Array:
    """Return the distance (R,) [m] of the sampled rows to the nearest other person's centre."""
    apart = np.full(len(people.track), np.nan)
    order = np.argsort(people.frame, kind="stable")
    frames = people.frame[order]
    for frame in np.unique(people.frame[rows]).tolist():
        first, end = np.searchsorted(frames, [frame, frame + 1]).tolist()
        there = order[first:end]
        if len(there) > 1:
            distance, _ = KDTree(people.position[there]).query(people.position[there], k=2)
            apart[there] = distance[:, 1]
    return apart
