"""The files of ``giveway data behave``: two tables and a picture."""

from pathlib import Path

from giveway.figures.behaviour_figure import Panel, behaviour_figure
from giveway.validation.behaviour.comparison import LEVELS, Comparison
from giveway.validation.files import names_of, write_files

FILES = names_of(("behaviour.csv", "people.csv"), ("behaviour",))
"""Names of all files that ``giveway data behave`` writes into its folder."""


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
    tables = {"behaviour.csv": found.summary, "people.csv": found.table}
    write_files(folder, tables, {"behaviour": behaviour_figure(panels, title)})
