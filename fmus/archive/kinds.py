"""The kinds of archives: one FMU, or a system of several FMUs (SSP 1.0)."""

from pathlib import Path
from typing import Final

DESCRIPTION: Final = "modelDescription.xml"
ROOT: Final = "fmiModelDescription"
SYSTEM: Final = "SystemStructure.ssd"
SYSTEM_ROOT: Final = "SystemStructureDescription"


def is_system(path: Path) -> bool:
    """Return whether a file is a system of several FMUs, by its name."""
    return path.suffix.lower() == ".ssp"
