"""The files of ``giveway data behave``: two tables and a picture."""

from pathlib import Path

from giveway.errors import ResultsError
from giveway.figures.behaviour_figure import Panel, behaviour_figure
from giveway.figures.style import save_figure
from giveway.validation.behaviour.comparison import LEVELS, Comparison

_PICTURES = ("behaviour.png", "behaviour.svg")
FILES = frozenset({"behaviour.csv", "people.csv", *_PICTURES})
"""Names of all files that ``giveway data behave`` writes into its folder."""
_DECIMALS = 6


def write_behaviour(found: Comparison, title: str, folder: Path) -> None:
    """Write the tables, and the picture as PNG and SVG.

    Args:
        found: Comparison.
        title: Title of the picture.
        folder: Folder for the files.

    Raises:
        ResultsError: a file cannot be written.
    """
    panels = [
        Panel(
            label=f"{each.measure.title} [{each.measure.unit}]",
            title=f"{each.ratio:.1f} times the noise floor",
            recorded=each.recorded,
            simulated=each.simulated,
            low=each.low,
            high=each.high,
            levels=LEVELS,
        )
        for each in found.distributions
    ]
    figure = behaviour_figure(panels, title)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, table in (("behaviour.csv", found.summary), ("people.csv", found.table)):
            table.round(_DECIMALS).to_csv(folder / name, index=False, lineterminator="\n")
        for name in _PICTURES:
            save_figure(figure, folder / name)
    except OSError as error:
        raise ResultsError(
            f"{folder}: cannot be written ({error.strerror}); name another folder with --out"
        ) from error
