"""Encounters as points on a map: colour, lightness and shape show the severity."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from giveway.figures.style import BLACK, ORANGE, VERMILION
from giveway.metrics import SEVERITIES

Conflict = tuple[str, float, float]
"""Severity of an encounter, and its place x and y [m] in the network."""

_MARKS = dict(
    zip(SEVERITIES, (("o", ORANGE, 26), ("^", VERMILION, 40), ("X", BLACK, 60)), strict=True)
)


def mark_conflicts(axes: Axes, conflicts: Sequence[Conflict]) -> None:
    """Mark encounters, the worst on top, and explain the marks that occur."""
    for order, (severity, (marker, colour, size)) in enumerate(_MARKS.items()):
        places = [(x, y) for kind, x, y in conflicts if kind == severity]
        if places:
            x, y = zip(*places, strict=True)
            axes.scatter(
                x, y, s=size, marker=marker, c=colour, edgecolors="white", linewidths=0.7,
                zorder=5 + order, label=f"{severity} ({len(places)})",
            )  # fmt: skip
    if conflicts:
        marks = [mark for mark in axes.collections if str(mark.get_label()).split(" ")[0] in _MARKS]
        axes.legend(
            handles=marks,
            title="By TTC or PET",
            loc="best",
            frameon=True,
            framealpha=0.9,
        )
