"""The files of ``giveway data behave`` about corridors: a table and a picture."""

from pathlib import Path

from giveway.figures.fundamental_diagram import fundamental_diagram
from giveway.validation.corridors.comparison import BIN, InCorridors
from giveway.validation.files import names_of, write_files

CORRIDOR_FILES = names_of(("corridor.csv",), ("corridor",))
"""Names of all files that ``giveway data behave`` writes about corridors."""


def write_corridors(found: InCorridors, title: str, folder: Path) -> None:
    """Write the table, and the fundamental diagram as PNG and SVG.

    Args:
        found: InCorridors.
        title: Title of the picture.
        folder: Folder for the files.

    Raises:
        ResultsError: a file cannot be written.
    """
    figure = fundamental_diagram(found.windows, found.speeds, BIN, title)
    write_files(folder, {"corridor.csv": found.table}, {"corridor": figure})
