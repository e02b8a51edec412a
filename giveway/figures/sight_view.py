"""The areas that an ego's cameras see, and the shadows that opaque bodies cast into them.

A shadow is where a child of 1.15 m would not be seen. In the plane it is the body's side as seen
from the camera, stretched away from it: from and to a multiple of the distance that heights tell.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
import pandas as pd
import shapely
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path as PlotPath

from giveway.config import EgoRunConfig
from giveway.ego.perception.sight import Mount, SightOptions
from giveway.ego.perception.visibility import CHILD, Eye, eyes_of
from giveway.figures.style import BLACK
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from giveway.plug_ins.options import read_options
from giveway.plug_ins.sockets import SENSOR
from giveway.run_data.scene import Opaque

SIGHT = "sight"
_ARC = np.radians(3.0)  # angle between the corners of a field of view
_AT_IT = 0.01  # distance [m] from a camera within which a wall is at it


@dataclass(frozen=True)
class SightView:
    """The sight of one ego for pictures.

    Attributes:
        mounts: Cameras of the ego.
        opaque: Walls and heights of vehicles.
        stretches: Times [s] from and until which each person is perceived, by the person's id.
    """

    mounts: tuple[Mount, ...]
    opaque: Opaque
    stretches: dict[str, list[tuple[float, float]]]

    @classmethod
    def of(cls, config: EgoRunConfig, sights: pd.DataFrame, opaque: Opaque) -> SightView | None:
        """The sight of an ego, or None if its sensor is another one than `sight`.

        Args:
            config: Configuration of the ego.
            sights: Rows of the ego in ``sights.csv``.
            opaque: Walls and heights of vehicles.
        """
        if config.perception.sensor != SIGHT:
            return None
        options = read_options(SIGHT, SightOptions, config.sensor_options, SENSOR)
        stretches: dict[str, list[tuple[float, float]]] = {}
        if len(sights):
            until = sights["until"].fillna(inf)
            for who, *stretch in zip(sights["id"], sights["time"], until, strict=True):
                stretches.setdefault(str(who), []).append((float(stretch[0]), float(stretch[1])))
        return cls(options.mounts, opaque, stretches)

    def perceives(self, person: str, time: float) -> bool:
        """Return whether a person is perceived at a time [s]."""
        stretches = self.stretches.get(person, ())
        return any(begin - 1e-6 <= time < until - 1e-6 for begin, until in stretches)

    def hidden(self, pose: Pose, vehicles: Iterable[tuple[str, Array]]) -> Any:
        """Return the area within the fields of view in which a child would not be seen.

        Args:
            pose: Front bumper of the ego [m] and its heading [rad].
            vehicles: Ids and corners (4, 2) [m] of the other vehicles.
        """
        sides = [self.opaque.walls]
        for name, corners in vehicles:
            tops = np.full((4, 1), self.opaque.heights.get(name, inf))
            sides.append(np.hstack([corners, np.roll(corners, -1, axis=0), tops]))
        eyes = eyes_of(np.array([mount.row for mount in self.mounts]), *pose)
        return hidden_area([Eye(*eye) for eye in eyes], np.concatenate(sides))


def draw_area(axes: Axes, area: Any) -> None:
    """Draw a hidden area as a shade."""
    for polygon in polygons_of(area):
        rings = [polygon.exterior, *polygon.interiors]
        outline = PlotPath.make_compound_path(
            *(PlotPath(ring.coords, closed=True) for ring in rings)
        )
        axes.add_patch(PathPatch(outline, facecolor=BLACK, alpha=0.25, linewidth=0, zorder=1.2))


def polygons_of(area: Any) -> list[Any]:
    """Return the polygons of an area."""
    return [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]


def hidden_area(eyes: Iterable[Eye], walls: Array, height: float = CHILD) -> Any:
    """Return the area within the fields of view in which nobody of a height [m] is seen."""
    fields, seen = [], []
    for eye in eyes:
        field = shapely.Polygon(_field(eye))
        fields.append(field)
        shadows = shapely.union_all(shapely.polygons(_shadows(eye, walls, height)))
        seen.append(field.difference(shadows))
    return shapely.union_all(fields).difference(shapely.union_all(seen))


def _field(eye: Eye) -> Array:
    """Return the corners (k, 2) [m] of a field of view."""
    count = int(2.0 * eye.half_angle / _ARC) + 2
    angles = eye.heading + np.linspace(-eye.half_angle, eye.half_angle, count)
    arc = eye.range * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.vstack([np.zeros(2), arc]) + (eye.x, eye.y)


def _shadows(eye: Eye, walls: Array, height: float) -> Array:
    """Return the corners (k, 4, 2) [m] of the shadows of walls, as far as the eye's range."""
    ends = walls[:, :4].reshape(-1, 2, 2) - (eye.x, eye.y)
    above, rises = walls[:, 4] - eye.z, height - eye.z
    with np.errstate(divide="ignore", invalid="ignore"):
        limit = np.where(np.isfinite(above), rises / above, 0.0)
    near = np.where(above > 0.0, np.maximum(limit, 1.0), 1.0)
    far = np.where(above > 0.0, inf, np.where(rises < 0.0, limit, 0.0))
    along = ends[:, 1] - ends[:, 0]
    size = np.maximum((along**2).sum(axis=1), 1e-12)
    at = np.clip(-(ends[:, 0] * along).sum(axis=1) / size, 0.0, 1.0)
    apart = np.hypot(*(ends[:, 0] + at[:, None] * along).T)
    far = np.minimum(far, 1.01 * eye.range / np.maximum(apart, _AT_IT))
    cast = far > near
    ends, near, far = ends[cast], near[cast, None, None], far[cast, None, None]
    return np.concatenate([near * ends, far * ends[:, ::-1]], axis=1) + (eye.x, eye.y)
