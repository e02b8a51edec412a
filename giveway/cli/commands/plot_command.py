"""The command ``giveway plot``."""

import math
from pathlib import Path

from matplotlib.figure import Figure
from rich.console import Console

from controller import Pid, TunedPid
from giveway.cli.screen.printing import print_place, writing
from giveway.config.files.presets import parameters_of
from giveway.errors import ConfigError
from giveway.figures import reference_figure, save_figure
from giveway.geometry.bodies import VehicleShape
from giveway.results.pictures import influence_picture

_SUFFIXES = (".png", ".svg", ".pdf")


def influence_command(out: Path, speeds: str, *, preset: str, length: float, width: float) -> None:
    """Draw figure 2 of the paper into ``out``.

    Raises:
        ConfigError: a value cannot be used.
        ResultsError: the picture cannot be written.
    """
    parameters = parameters_of(preset)
    for flag, value in (("--length", length), ("--width", width)):
        if not (math.isfinite(value) and 0.0 < value <= 50.0):
            raise ConfigError(f"{flag} {value}: expected a number between 0 and 50 [m]")
    _require_picture(out)
    shape = VehicleShape(length, width)
    figure = influence_picture(_speeds(speeds), shape, parameters)
    _write(figure, out)


def reference_command(out: Path) -> None:
    """Draw the reference speeds of the paper's PID (its figure 3) and of the tuned PID.

    Raises:
        ConfigError: ``out`` is no name of a picture.
        ResultsError: the picture cannot be written.
    """
    _require_picture(out)
    printed, tuned = Pid(), TunedPid()
    own = printed.parameters
    figure = reference_figure(
        [("pid-paper", printed.reference_speed), ("pid-tuned", tuned.reference_speed)],
        safe_distance=own.safe_distance,
        buffer_distance=own.buffer_distance,
    )
    _write(figure, out)


def _require_picture(out: Path) -> None:
    if out.suffix.lower() not in _SUFFIXES:
        raise ConfigError(f"--out {out}: expected a name that ends with {', '.join(_SUFFIXES)}")


def _write(figure: Figure, out: Path) -> None:
    with writing(out, "name another file with --out"):
        save_figure(figure, out)
    print_place(Console(), "Picture", out)


def _speeds(text: str) -> list[float]:
    try:
        speeds = [float(part) for part in text.split(",")]
    except ValueError:
        speeds = []
    if not speeds or len(speeds) > 12 or not all(abs(speed) <= 60.0 for speed in speeds):
        raise ConfigError(
            f"--speeds '{text}': expected up to 12 numbers between -60 and 60 [m/s], like 0,1,2,4"
        )
    return speeds
