"""The fundamental diagram of recorded and simulated people: speed over density."""

import pandas as pd
from matplotlib.figure import Figure

from giveway.figures.style import BLACK, VERMILION, quiet_grid, styled


@styled
def fundamental_diagram(
    points: pd.DataFrame, means: pd.DataFrame, width: float, title: str
) -> Figure:
    """Draw the speed over the density: points, and a line through the means of bins.

    Args:
        points: Points, with columns who, density [/m^2], speed [m/s].
        means: Mean speed [m/s] by the number of a bin, with a column for each of who.
        width: Width [/m^2] of a bin.
        title: Title of the figure.
    """
    figure = Figure(figsize=(5.2, 3.8), layout="constrained")
    axes = figure.subplots()
    middles = (means.index + 0.5) * width
    for who, colour, marker in zip(means.columns, (BLACK, VERMILION), ("o", "^"), strict=True):
        of = points[points["who"] == who]
        axes.scatter(of["density"], of["speed"], s=9, color=colour, alpha=0.3, linewidth=0)
        axes.plot(middles, means[who], color=colour, marker=marker, label=who)
    axes.set(title=title, xlabel="density [1/m²]", ylabel="speed along the corridor [m/s]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    quiet_grid(axes)
    axes.legend()
    return figure
