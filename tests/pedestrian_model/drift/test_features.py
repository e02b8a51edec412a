"""The numbers that describe a person's last seconds, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from pedestrian_model.drift.features import ACROSS, ALONG, FEATURES, fill_features, steps_back

DT = 0.05


def numbers_of(tracks, known=None):
    """Headings and numbers of all people of tracks (K, n, 4), newest first."""
    n = tracks.shape[1]
    rows = np.arange(n)
    known = np.full(n, len(tracks) - 1) if known is None else np.array(known)
    heading, numbers = np.empty((n, 2)), np.empty((n, FEATURES))
    fill_features(tracks, 0, rows, known, steps_back(DT), DT, (rows, heading, numbers))
    return heading, numbers


def moving(start, velocity, acceleration=(0.0, 0.0), steps=61):
    """Tracks (K, 1, 4), newest first, of a person who accelerates evenly up to now."""
    ago = -DT * np.arange(steps)[:, None]
    v = np.array(velocity) + ago * np.array(acceleration)
    x = np.array(start) + ago * np.array(velocity) + 0.5 * ago**2 * np.array(acceleration)
    return np.concatenate([x, v], axis=1)[:, None]


def test_a_steady_walker_alone_has_only_a_speed():
    heading, numbers = numbers_of(moving([3.0, 1.0], [0.6, 0.8]))
    assert heading[0] == pytest.approx([0.6, 0.8])
    expected = np.zeros(FEATURES)
    expected[[0, len(ALONG)]] = 1.0
    assert numbers[0] == pytest.approx(expected, abs=1e-9)


def test_an_acceleration_shows_in_velocities_and_means():
    _, numbers = numbers_of(moving([0.0, 0.0], [1.0, 0.0], [0.2, 0.1]))
    said = dict(zip(ALONG, numbers[0], strict=False))
    assert said["velocity now - 1 s ago"] == pytest.approx(0.2)
    assert said["mean velocity of the last 1 s - velocity"] == pytest.approx(-0.1)
    across = dict(zip(ACROSS, numbers[0, len(ALONG) :], strict=True))
    assert across["velocity now - 1 s ago"] == pytest.approx(0.1)


def test_neighbours_ahead_and_beside_count_by_their_velocity():
    tracks = np.concatenate(
        [moving([0, 0], [1, 0]), moving([2, 0], [0.4, 0]), moving([0, 2.5], [-1, 0])], axis=1
    )
    said = dict(zip(ALONG, numbers_of(tracks)[1][0], strict=False))
    assert said["mean velocity of the people within 3 m - velocity"] == pytest.approx(-1.3)
    assert said["the same, of those who walk in a similar direction"] == pytest.approx(-0.6)
    follows = said["speed of the next person ahead - speed, weighted by the distance"]
    assert follows == pytest.approx(-0.6 * np.exp(-2.0 / 1.5))


def test_a_mirror_turns_the_numbers_across_but_the_speed():
    rng = np.random.default_rng(4)
    tracks = np.cumsum(rng.normal(0, 0.05, (61, 5, 4)), axis=0)
    there, mirrored = numbers_of(tracks)[1], numbers_of(tracks * [1, -1, 1, -1])[1]
    sign = np.ones(FEATURES)
    sign[len(ALONG) + 1 :] = -1.0
    assert mirrored == pytest.approx(there * sign)


def test_the_unknown_past_is_not_read():
    tracks = moving([0.0, 0.0], [1.0, 0.0])
    tracks[1:] = np.nan
    _, numbers = numbers_of(tracks, known=[0])
    assert numbers[0, 0] == 1.0
    assert np.isfinite(numbers).all()


def test_a_standing_person_has_no_heading():
    heading, numbers = numbers_of(moving([0.0, 0.0], [0.1, 0.0]))
    assert not heading.any()
    assert not numbers.any()
