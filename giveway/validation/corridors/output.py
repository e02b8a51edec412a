"""The files of ``giveway data corridor``: two tables and a picture."""

from pathlib import Path

import numpy as np

from giveway.figures.fundamental_diagram import Points, fundamental_diagram
from giveway.validation.corridors.comparison import BIN, Comparison
from giveway.validation.files import names_of, write_files

FILES = names_of(("corridor.csv", "points.csv"), ("corridor",))
"""Names of all files that ``giveway data corridor`` writes into its folder."""


def write_corridors(found: Comparison, title: str, folder: Path) -> None:
    """Write the tables, and the fundamental diagram as PNG and SVG.

    Args:
        found: Comparison.
        title: Title of the picture.
        folder: Folder for the files.

    Raises:
        ResultsError: a file cannot be written.
    """
    middles = np.arange(0.5, found.bins) * BIN
    people = [
        Points(who, each.density, each.speed, middles, each.speeds(found.bins))
        for who, each in (("recorded", found.recorded), ("simulated", found.simulated))
    ]
    tables = {"corridor.csv": found.table, "points.csv": found.points}
    write_files(folder, tables, {"corridor": fundamental_diagram(people, title)})
