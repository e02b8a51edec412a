"""The style of giveway's pictures, which does not depend on the user's matplotlib settings.

The colours are those of Okabe & Ito (2008), which people with all common kinds of colour vision can
tell apart. Shaded parts differ in lightness as well, for print in black and white.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import wraps
from io import BytesIO
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from giveway.gate import write_whole

BLACK = "#000000"
ORANGE = "#E69F00"
SKY_BLUE = "#56B4E9"
GREEN = "#009E73"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#767676"
LIGHT_GREY = "#ECECEC"

_STYLE = {
    "axes.axisbelow": True,
    "axes.edgecolor": GREY,
    "axes.formatter.useoffset": False,  # whole coordinates, even far from the origin
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 10,
    "figure.titlesize": 11,
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "lines.solid_capstyle": "round",
    "svg.hashsalt": "giveway",
    "xtick.color": GREY,
    "xtick.labelcolor": BLACK,
    "xtick.labelsize": 8,
    "ytick.color": GREY,
    "ytick.labelcolor": BLACK,
    "ytick.labelsize": 8,
}

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def house_style() -> AbstractContextManager[None]:
    """Return a context with matplotlib's own defaults and giveway's on top."""
    return style.context(["default", _STYLE])


def styled(draw: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Let a function draw in the house style."""

    @wraps(draw)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
        with house_style():
            return draw(*args, **kwargs)

    return wrapper


class NotebookFigure(Figure):
    """A figure that notebooks show, with any backend of matplotlib."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        with house_style():
            self.savefig(picture, format="png", dpi=120)
        return picture.getvalue()


def save_figure(figure: Figure, path: Path, dpi: float = 150) -> None:
    """Write a picture whose bytes depend only on its content.

    An exception is an SVG with panels of equal scale: its ids are hashes of positions, whose last
    digit varies in matplotlib's layout solver.

    Args:
        figure: Figure to write.
        path: Path of the picture; its suffix is the format: .png, .svg or .pdf.
        dpi: Pixels per inch of a PNG.

    Raises:
        OSError: the file cannot be written.
    """
    # By default, the formats have a creation date and, for SVG, random element ids.
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with house_style():
        picture, suffix = BytesIO(), path.suffix.lower()
        form, metadata = suffix.removeprefix(".") or None, undated.get(suffix, {})
        figure.savefig(picture, format=form, dpi=dpi, metadata=metadata)
    write_whole(path, picture.getvalue())


def quiet_grid(axes: Axes) -> None:
    """Draw a light grid that helps to read values."""
    axes.grid(color=BLACK, alpha=0.08, linewidth=0.7)


def keep_panels(
    grid: NDArray[Any], count: int, *, x: str = "x [m]", y: str = "y [m]"
) -> list[Axes]:
    """Return the first ``count`` map panels of a grid, labelled along the outside."""
    columns = grid.shape[1]
    panels: list[Axes] = list(grid.flat)
    for axes in panels[count:]:
        axes.remove()
    for axes in panels[:count:columns]:
        axes.set_ylabel(y)
    for axes in panels[max(count - columns, 0) : count]:  # the lowest panel of each column
        axes.set_xlabel(x)
        axes.tick_params(labelbottom=True)
    return panels[:count]
