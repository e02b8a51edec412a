"""Trajectories in longitude and latitude: where they belong, and back again."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from giveway.errors import ResultsError
from giveway.exports.geojson import Projection, write_geojson
from giveway.exports.net import Net
from giveway.exports.sampling import sampled

pyproj = pytest.importorskip("pyproj")


def test_a_round_trip_keeps_places_within_a_centimetre(run, tmp_path):
    file = tmp_path / "run.geojson"
    samples = sampled(run, 0.5)
    write_geojson(run, samples, file)
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["type"] == "FeatureCollection"
    lines = {
        feature["properties"]["id"]: feature
        for feature in content["features"]
        if feature["geometry"]["type"] == "LineString"
    }
    net = Net.of(run)
    project = pyproj.Proj(net.projection)
    for track in (track for track in samples.tracks if len(track) > 1):
        feature = lines.pop(track.id)
        degrees = np.array(feature["geometry"]["coordinates"])
        place = np.column_stack(project(degrees[:, 0], degrees[:, 1])) + net.offset
        assert np.hypot(*(place - np.column_stack([track.x, track.y])).T).max() < 0.01
        assert len(feature["properties"]["times"]) == len(degrees)
        assert degrees[0] == pytest.approx([11.563, 48.144], abs=0.01)  # Munich
    assert not lines


def test_a_metre_is_a_metre(run):
    """Against the length of a degree of latitude there, 111.2 km (Snyder 1987, WGS 84)."""
    projection = Projection(Net.of(run))
    longitude, latitude = projection.to_degrees(np.array([0.0, 0.0]), np.array([0.0, 1000.0]))
    assert 111_200.0 * (latitude[1] - latitude[0]) == pytest.approx(1000.0, rel=3e-3)
    assert abs(longitude[1] - longitude[0]) < 1e-3


def test_a_network_without_a_projection_is_refused_in_one_line(run, tmp_path):
    nowhere = dataclasses.replace(run, config=run.config.model_copy(update={"scenario": "street"}))
    with pytest.raises(ResultsError, match=r"street.*no projection .*netconvert") as caught:
        write_geojson(nowhere, sampled(run), tmp_path / "none.geojson")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "none.geojson").exists()
