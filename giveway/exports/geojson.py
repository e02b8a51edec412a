"""The export of trajectories on a map: GeoJSON (RFC 7946) in longitude and latitude, WGS 84.

It has a line for each presence of a person or vehicle, with its times, and a point for each
conflict.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from giveway.errors import InstallationError, ResultsError
from giveway.exports.net import Net
from giveway.exports.sampling import Sampled
from giveway.geometry.kernel import Array
from giveway.replays.run_folder import RunFolder

_DECIMALS = 9  # decimals of degrees: a tenth of a millimetre


class Projection:
    """The projection between a network's coordinates and longitude and latitude.

    Args:
        net: Network with the projection.

    Raises:
        InstallationError: pyproj is not installed.
        ResultsError: the network has no projection.
    """

    def __init__(self, net: Net) -> None:
        parameters = net.projection.strip()
        if parameters in {"", "!", "-", ".", "?"}:
            raise ResultsError(
                f"{net.file}: its <location> has no projection (projParameter = "
                f"'{parameters or '!'}'), so that its place on earth is unknown; expected a "
                "network that netconvert made from OpenStreetMap or with --proj"
            )
        try:
            import pyproj
        except ImportError as error:
            raise InstallationError(
                "GeoJSON needs pyproj; install it with: pip install 'giveway[geo]'"
            ) from error
        try:
            self._proj = pyproj.Proj(parameters)
        except pyproj.exceptions.CRSError as error:
            said = str(error).partition("\n")[0]
            raise ResultsError(
                f"{net.file}: projParameter = '{parameters}': PROJ does not know it ({said})"
            ) from error
        self._offset = net.offset

    def to_degrees(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return longitude and latitude [deg] of points [m]."""
        longitude, latitude = self._proj(x - self._offset[0], y - self._offset[1], inverse=True)
        return np.asarray(longitude), np.asarray(latitude)


def write_geojson(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write the trajectories of a run as GeoJSON.

    Returns:
        The written file, in words.

    Raises:
        GivewayError: the network cannot be read or has no projection, or pyproj is missing.
    """
    projection = Projection(Net.of(run))
    features = []
    for track in sampled.tracks:
        if len(track) < 2:
            continue
        line = np.column_stack(projection.to_degrees(track.x, track.y)).round(_DECIMALS)
        times = [sampled.time(track.first + k) for k in range(len(track))]
        about = {"id": track.id, "type": track.type, "begin": times[0], "end": times[-1]}
        features.append(_feature("LineString", line.tolist(), about | {"times": times}))
    conflicts = run.pedestrians
    if len(conflicts):
        conflicts = conflicts[conflicts["conflict_x"].notna()]
        x, y = (conflicts[f"conflict_{axis}"].to_numpy(np.float64) for axis in ("x", "y"))
        points = np.column_stack(projection.to_degrees(x, y)).round(_DECIMALS)
        for place, row in zip(points.tolist(), conflicts.to_dict("records"), strict=True):
            about = {"id": row["id"], "ego": row["ego"], "type": "conflict"}
            about |= {"time": row["conflict_time"], "severity": row["severity"]}
            features.append(_feature("Point", place, about))
    with file.open("w", encoding="utf-8", newline="\n") as out:
        json.dump({"type": "FeatureCollection", "features": features}, out, separators=(",", ":"))
        out.write("\n")
    return f"{len(features)} lines and points in longitude and latitude"


def _feature(kind: str, coordinates: Any, properties: dict[str, Any]) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": properties}
