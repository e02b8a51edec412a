"""The folder of a new scenario, which is written when all of it could be made."""

import io
import re
import shutil
import tempfile
from contextlib import redirect_stderr
from pathlib import Path
from typing import Final

from giveway.errors import ResultsError, ScenarioError, remedy, retold
from giveway.results.folder import check_folder
from giveway.scenario_builder.city import Demand, map_configuration, map_traffic
from giveway.scenario_builder.description import read_street
from giveway.scenario_builder.map_network import network_sources
from giveway.scenario_builder.street import street_files
from sumo_scenarios import BuildError
from sumo_scenarios.build import build

_UNSAFE: Final = re.compile(r"[^A-Za-z0-9_-]+")  # SUMO separates names of files by such characters
_ENDINGS: Final = (
    *(".nod.xml", ".edg.xml", ".con.xml", ".tll.xml", ".typ.xml", ".netccfg", ".net.xml"),
    *(".rou.xml", ".cars.rou.xml", ".people.rou.xml", ".sumocfg", ".giveway.toml"),
)


def write_scenario(
    source: Path, out: Path | None = None, demand: Demand | None = None, *, force: bool = False
) -> tuple[Path, int]:
    """Write a scenario into a folder.

    Args:
        source: Description of a street (TOML), or a map of OpenStreetMap.
        out: Folder, or None for one of the source's name.
        demand: Traffic of a map, or None for the usual one; a street describes its own.
        force: True to replace a scenario there.

    Returns:
        The folder, and the number of netconvert's warnings.

    Raises:
        GivewayError: the source, its map or the folder cannot be used, or netconvert is missing.
    """
    name = _UNSAFE.sub("_", source.name.partition(".")[0]) or "scenario"
    folder = Path(name) if out is None else out
    ours = frozenset(name + ending for ending in _ENDINGS)
    check_folder(folder, force=force, ours=ours, writer="giveway new")
    with tempfile.TemporaryDirectory() as scratch, retold(BuildError, ScenarioError):
        made = Path(scratch) / name
        made.mkdir()
        warnings = _make(source, made, name, demand or Demand())
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for former in ours:
                (folder / former).unlink(missing_ok=True)
            for file in sorted(made.iterdir()):
                shutil.copyfile(file, folder / file.name)
        except OSError as error:
            msg = f"{folder}: cannot be written ({error.strerror}); {remedy(error)} with --out"
            raise ResultsError(msg) from error
    return folder, warnings


def _make(source: Path, folder: Path, name: str, demand: Demand) -> int:
    """Make the files in an empty folder, and return the number of netconvert's warnings."""
    if source.suffix == ".toml":
        _fill(folder, street_files(read_street(source), name))
        _build(folder)
        return 0
    with tempfile.TemporaryDirectory() as scratch:
        sources, warnings = network_sources(source, name, Path(scratch))
    _fill(folder, sources | map_configuration(name, demand))
    _fill(folder, map_traffic(_build(folder), name, demand))
    return warnings


def _build(folder: Path) -> Path:
    """Build the network of a folder, without netconvert's warnings: they are told once."""
    with redirect_stderr(io.StringIO()):
        return build(folder.as_posix())


def _fill(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8", newline="\n")
