"""The arguments of ``giveway fmu check`` and ``identify``: an FMU and its profile."""

import math
from pathlib import Path

from matplotlib.figure import Figure

from fmus import FmuError
from fmus.profile.vehicle_profile import VehicleProfile, read_profile
from giveway.cli.screen.printing import writing
from giveway.errors import ConfigError, retold
from giveway.figures import save_figure


def require_fmu(path: Path) -> None:
    """Make sure that the file exists.

    Raises:
        ConfigError: it does not exist.
    """
    if not path.is_file():
        what = "a folder" if path.is_dir() else "no such file"
        raise ConfigError(f"{path}: {what}; expected an FMU, a file like car.fmu")


def require_number(flag: str, value: float, low: float, high: float, unit: str) -> None:
    """Make sure that a flag's number is above ``low`` and not above ``high``.

    Raises:
        ConfigError: the number is outside.
    """
    if not (math.isfinite(value) and low < value <= high):
        raise ConfigError(
            f"{flag} {value:g}: expected a number above {low:g} and up to {high:g} [{unit}]"
        )


def profile_in(path: Path | None) -> VehicleProfile | None:
    """Return the profile that the user names, or None if no profile is named.

    Raises:
        ConfigError: the profile cannot be used.
    """
    if path is None:
        return None
    with retold(FmuError, ConfigError):
        return read_profile(path)


def save_picture(figure: Figure, path: Path) -> None:
    """Write a picture, and the folders that it needs.

    Raises:
        ResultsError: the picture cannot be written.
    """
    with writing(path, "name another with --out"):
        save_figure(figure, path)
