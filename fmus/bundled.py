"""Where the shipped FMUs are."""

from pathlib import Path
from typing import Final, Literal

FmiVersion = Literal["2.0", "3.0"]

MODEL: Final = "LongitudinalVehicle"
FILES: Final[dict[FmiVersion, str]] = {"2.0": f"{MODEL}.fmi2.fmu", "3.0": f"{MODEL}.fmi3.fmu"}


def bundled_fmu(fmi_version: FmiVersion = "2.0") -> Path:
    """The shipped vehicle FMU for an FMI version; FMI 2.0 is set up faster."""
    return Path(__file__).parent / FILES[fmi_version]
