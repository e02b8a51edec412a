"""The trained numbers that giveway ships."""

from __future__ import annotations

import numpy as np

from pedestrian_model.drift.features import ACROSS, ALONG
from pedestrian_model.drift.trained import EXACT, FILTERED, fits, unseen_fit


def test_every_tree_ends_and_asks_only_for_its_numbers():
    for fit in fits().values():
        feature, value, below, roots, start = fit.forest
        inner = feature >= 0
        assert (below[inner] > np.flatnonzero(inner)).all()
        assert below[inner].max() + 1 < len(feature)
        assert feature.max() < max(len(ALONG), len(ACROSS))
        assert np.isfinite(value).all()
        assert np.isfinite(start).all()
        assert roots.max() < len(feature)


def test_the_spread_grows_with_the_horizon():
    for fit in fits().values():
        at_walking_speed = fit.deviation[..., 0] + 1.2 * fit.deviation[..., 1]
        assert (at_walking_speed > 0.0).all()
        assert (np.diff(at_walking_speed, axis=0) > 0.0).all()


def test_clips_are_predicted_by_a_fit_that_has_not_seen_them():
    everything = fits()[FILTERED]
    assert unseen_fit(["mine_01"]) is everything
    for clip in everything.clips:
        fit = unseen_fit([clip])
        assert fit is not None
        assert clip not in fit.clips
    assert unseen_fit(everything.clips) is None


def test_recordings_are_never_predicted_by_the_fit_of_exact_velocities():
    assert unseen_fit([]).name != EXACT
