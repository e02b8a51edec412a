"""The fundamental diagram of recorded and simulated people: speed over density."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

from giveway.figures.style import BLACK, VERMILION, quiet_grid, styled
from giveway.geometry.kernel import Array


class Points(NamedTuple):
    """The points of recorded, or of simulated people.

    Attributes:
        label: Label in the legend.
        density: Density (w,) [/m^2] of each point.
        speed: Speed (w,) [m/s] of each point.
        middles: Middle (b,) [/m^2] of each bin of density.
        means: Mean speed (b,) [m/s] of each bin; nan without one.
    """

    label: str
    density: Array
    speed: Array
    middles: Array
    means: Array


@styled
def fundamental_diagram(people: Sequence[Points], title: str) -> Figure:
    """Draw the speed over the density: points, and a line through the means of the bins.

    Args:
        people: Points of recorded and of simulated people, in this order.
        title: Title of the figure.
    """
    figure = Figure(figsize=(5.2, 3.8), layout="constrained")
    axes = figure.subplots()
    for each, colour, marker in zip(people, (BLACK, VERMILION), ("o", "^"), strict=True):
        axes.scatter(each.density, each.speed, s=9, color=colour, alpha=0.3, linewidth=0)
        axes.plot(each.middles, each.means, color=colour, marker=marker, label=each.label)
    axes.set(title=title, xlabel="density [1/m²]", ylabel="speed along the corridor [m/s]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    quiet_grid(axes)
    axes.legend()
    return figure
