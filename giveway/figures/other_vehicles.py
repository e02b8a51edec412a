"""The other vehicles of a snapshot: where they are, and their rectangles."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from giveway.figures.style import GREY
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.run_data.tracks import BackgroundTrack


def vehicles_at(time: float, background: BackgroundTrack) -> list[tuple[str, Array]]:
    """Return ids and corners (4, 2) [m] of the other vehicles at ``time`` [s]."""
    known, found = background.time[background.time <= time + 1e-9], []
    if not known.size:
        return []
    for b in np.flatnonzero(background.time == known[-1]):
        heading = float(background.heading[b])
        driven = background.speed[b] * (time - known[-1])
        front = np.array((background.x[b], background.y[b]))
        front += driven * np.array((np.cos(heading), np.sin(heading)))
        shape = VehicleShape(float(background.length[b]), float(background.width[b]))
        found.append((str(background.id[b]), shape.corners(front, heading)))
    return found


def draw_vehicles(axes: Axes, vehicles: Sequence[tuple[str, Array]]) -> None:
    """Draw the other vehicles as light rectangles."""
    for _, corners in vehicles:
        axes.add_patch(
            Polygon(corners, facecolor="#B0B0B0", edgecolor=GREY, zorder=1.5, label="background")
        )
