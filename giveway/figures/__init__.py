"""The pictures of runs; importing them needs matplotlib, but neither pyplot nor a display."""

from giveway.figures.influence_figure import influence_figure
from giveway.figures.reference import reference_figure
from giveway.figures.state import state_figure
from giveway.figures.style import save_figure
from giveway.figures.top_view import crowd_view_figure, top_view_figure

__all__ = [
    "crowd_view_figure",
    "influence_figure",
    "reference_figure",
    "save_figure",
    "state_figure",
    "top_view_figure",
]
