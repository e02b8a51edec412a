"""The road underneath a picture: lanes, crossings, and traffic lights as coloured stop lines."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from giveway.figures.style import GREY, LIGHT_GREY
from giveway.figures.view import Box
from giveway.run_data.road_marks import RoadMarks, Zebra, shown
from giveway.run_data.tracks import SignalTrack

Road = Sequence[NDArray[np.float64]]
"""Lines (k, 2) [m] to draw underneath; a line that ends where it starts is a filled area."""

STRIPE = 0.5  # Length [m] of a painted stripe, and of the gap behind it
LONGEST = 20.0  # Largest length [m] of a crossing that is drawn outside of the view
UNPAINTED = "#CFCFCF"  # Colour of a crossing's ground, on which white stripes are visible
LIGHTS = {"G": "#009E73", "y": "#E69F00", "r": "#D7191C", "": GREY}


def draw_road(axes: Axes, road: Road) -> None:
    """Draw areas in light grey and lines in grey."""
    for line in road:
        if len(line) > 2 and np.array_equal(line[0], line[-1]):
            axes.add_patch(Polygon(line, facecolor=LIGHT_GREY, edgecolor="white", zorder=0))
        else:
            axes.plot(*np.asarray(line).T, color="#C8C8C8", linewidth=0.8, zorder=0.5)


def draw_marks(axes: Axes, marks: RoadMarks, states: Mapping[str, str] | None, view: Box) -> None:
    """Draw stripes on crossings, and a bar at each stop line in the colour of its light.

    Args:
        axes: Axes to draw into.
        marks: Crossings and stop lines.
        states: State of each traffic light by its id, or None for grey stop lines.
        view: Rectangle to show; everything outside is left out.
    """
    marks = marks.within(
        (view.left - LONGEST, view.bottom - LONGEST), (view.right + LONGEST, view.top + LONGEST)
    )
    if marks.zebras:
        ground = [outline for zebra in marks.zebras for outline in bands(zebra, whole=True)]
        stripes = [stripe for zebra in marks.zebras for stripe in bands(zebra)]
        for shapes, colour, name in (
            (ground, UNPAINTED, "crossings"),
            (stripes, "white", "stripes"),
        ):
            painted = PolyCollection(shapes, facecolors=colour, linewidths=0.0, label=name)
            painted.set_zorder(0.6 if name == "crossings" else 0.7)
            axes.add_collection(painted, autolim=False)
    if marks.heads:
        told = states or {}
        colours = [
            LIGHTS[shown("".join(_letters(told.get(head.system, ""), head.links)))]
            for head in marks.heads
        ]
        lines = LineCollection(
            [np.array(head.ends) for head in marks.heads], colors=colours, linewidths=2.4,
            capstyle="butt", zorder=1.0, label="lights",
        )  # fmt: skip
        axes.add_collection(lines, autolim=False)


def states_at(signals: SignalTrack | None, time: float) -> dict[str, str]:
    """Return the latest recorded state of each light at ``time`` [s]."""
    if signals is None:
        return {}
    until = signals.time <= time + 1e-9
    return dict(zip(signals.system[until].tolist(), signals.state[until].tolist(), strict=True))


def bands(zebra: Zebra, *, whole: bool = False) -> list[NDArray[np.float64]]:
    """Return the stripes (4, 2) [m] of a crossing, or only its outline."""
    start, end = np.array(zebra.ends)
    length = float(np.hypot(*(end - start)))
    if length <= 0.0:
        return []
    along = (end - start) / length
    aside = zebra.width / 2 * np.array((-along[1], along[0]))
    count = max(1, int(length / (2.0 * STRIPE) + 1e-6))
    first = (length - (2 * count - 1) * STRIPE) / 2
    spans = [(first + 2 * k * STRIPE, first + (2 * k + 1) * STRIPE) for k in range(count)]
    return [
        start + np.array((a * along - aside, b * along - aside, b * along + aside,
                          a * along + aside))
        for a, b in ([(0.0, length)] if whole else spans)
    ]  # fmt: skip


def _letters(state: str, links: tuple[int, ...]) -> list[str]:
    return [state[link] for link in links if 0 <= link < len(state)]
