"""The check of foreign FMUs' archives, before a command loads what it needs for its work.

An archive that is refused costs only its examination: neither SUMO nor any numerical library is
loaded for it.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from giveway.config.files.layers import Layer, merge, read_toml
from giveway.config.tables.basics import BUNDLED_VEHICLES
from giveway.errors import VehicleError, as_request, retold
from giveway.plug_ins.finding import is_fmu


@as_request()
def require_archives(config: Path | None, settings: Mapping[str, Any]) -> None:
    """Check the archives of the FMUs that a file and the flags name.

    A missing FMU is left to the command, whose message can say what it was for.

    Args:
        config: TOML file, or None.
        settings: Settings given by flags.

    Raises:
        ConfigError: the file cannot be read.
        VehicleError: an archive is hostile, damaged or too large.
    """
    layers = [] if config is None else [read_toml(config)]
    merged = merge([*layers, Layer("command line", dict(settings), from_flags=True)])
    paths = [path for path in _named(merged) if path.is_file()]
    if not paths:
        return
    from fmus.archive.archive_check import open_archive
    from fmus.errors import FmuError

    for path in paths:
        with retold(FmuError, VehicleError):
            open_archive(path)


def _named(settings: Mapping[str, Any]) -> Iterator[Path]:
    egos = settings.get("egos")
    for table in (settings, *(egos if isinstance(egos, list) else ())):
        vehicle = table.get("vehicle") if isinstance(table, Mapping) else None
        fmu = vehicle.get("fmu") if isinstance(vehicle, Mapping) else None
        if isinstance(fmu, str) and fmu not in BUNDLED_VEHICLES and "\0" not in fmu:
            yield Path(fmu)
        controller = table.get("controller") if isinstance(table, Mapping) else None
        if isinstance(controller, str) and is_fmu(controller) and "\0" not in controller:
            yield Path(controller)
