"""``giveway plot``."""

from __future__ import annotations

import difflib
import math
from typing import TYPE_CHECKING

from rich.console import Console

from giveway.errors import ConfigError, ResultsError
from giveway.figures import save_figure
from giveway.pictures import influence_picture
from giveway.tracks import VehicleShape
from pedestrian_model import PRESETS

if TYPE_CHECKING:
    from pathlib import Path

_SUFFIXES = (".png", ".svg", ".pdf")


def influence_command(out: Path, speeds: str, *, preset: str, length: float, width: float) -> None:
    """Draw figure 2 of the paper into ``out``.

    Raises:
        ConfigError: a value cannot be used.
        ResultsError: the picture cannot be written.
    """
    if preset not in PRESETS:
        close = difflib.get_close_matches(preset.upper(), PRESETS, n=1)
        hint = f"; did you mean '{close[0]}'?" if close else ""
        msg = f"--preset '{preset}': expected one of {', '.join(PRESETS)}{hint}"
        raise ConfigError(msg)
    for flag, value in (("--length", length), ("--width", width)):
        if not (math.isfinite(value) and 0.0 < value <= 50.0):
            msg = f"{flag} {value}: expected a number between 0 and 50 [m]"
            raise ConfigError(msg)
    if out.suffix.lower() not in _SUFFIXES:
        msg = f"--out {out}: expected a name that ends with {', '.join(_SUFFIXES)}"
        raise ConfigError(msg)
    figure = influence_picture(_speeds(speeds), VehicleShape(length, width), PRESETS[preset])
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        save_figure(figure, out)
    except OSError as error:
        msg = f"{out}: cannot be written ({error.strerror}); name another file with --out"
        raise ResultsError(msg) from error
    Console().print(f"Picture in [bold]{out}[/bold]", highlight=False)


def _speeds(text: str) -> list[float]:
    try:
        speeds = [float(part) for part in text.split(",")]
    except ValueError:
        speeds = []
    if not speeds or len(speeds) > 12 or not all(abs(speed) <= 60.0 for speed in speeds):
        msg = f"--speeds '{text}': expected up to 12 numbers between -60 and 60 [m/s], like 0,1,2,4"
        raise ConfigError(msg)
    return speeds
