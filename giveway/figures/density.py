"""The mean density of people on a map."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from giveway.config.tables.measures import MeasureConfig
from giveway.figures.conflict_points import Conflict, mark_conflicts
from giveway.figures.style import SKY_BLUE, NotebookFigure, styled
from giveway.measures import DensityMap


@styled
def density_figure(
    found: DensityMap,
    measures: Sequence[MeasureConfig],
    *,
    conflicts: Sequence[Conflict] = (),
    title: str = "",
) -> Figure:
    """Draw the mean density on a grid, the measures and all egos' conflicts, to scale.

    Args:
        found: Density to draw.
        measures: Measures to draw as lines.
        conflicts: Severity and place of each conflict.
        title: Title of the figure.
    """
    aspect = (found.top - found.bottom) / (found.right - found.left)
    height = min(max(7.5 * aspect, 4.0), 9.0)
    figure = NotebookFigure(
        layout="constrained", figsize=(max(height / aspect, 4.0) + 1.6, height + 0.8)
    )
    axes = figure.subplots()
    extent = (found.left, found.right, found.bottom, found.top)
    image = axes.imshow(found.density, extent=extent, cmap="magma_r", interpolation="nearest")
    for measure in measures:
        closed = (*measure.places, measure.places[0]) if measure.area else measure.places
        x, y = zip(*closed, strict=True)
        axes.plot(x, y, color=SKY_BLUE)
        axes.annotate(measure.name, (x[0], y[0]), xytext=(3, 3), textcoords="offset points")
    mark_conflicts(axes, conflicts)
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal", xlabel="x [m]", ylabel="y [m]")
    figure.colorbar(image, ax=axes, label="Mean density [1/m²]", shrink=0.8, aspect=30)
    figure.suptitle(title)
    return figure
