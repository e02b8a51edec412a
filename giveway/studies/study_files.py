"""The files of studies: the bundled ones by name, and a user's own."""

from importlib.resources import files
from pathlib import Path

from giveway.errors import ConfigError

_FOLDER = "bundled"


def bundled_studies() -> tuple[str, ...]:
    """Return the names of the bundled studies."""
    folder = files("giveway.studies") / _FOLDER
    return tuple(
        sorted(
            entry.name.removesuffix(".toml")
            for entry in folder.iterdir()
            if entry.name.endswith(".toml")
        )
    )


def find_study(name: str | Path) -> Path:
    """Return the file of a bundled study, or the user's own .toml file.

    Raises:
        ConfigError: there is no such study.
    """
    path = Path(name)
    if path.suffix == ".toml":
        return path
    if str(name) in bundled_studies():
        return Path(str(files("giveway.studies") / _FOLDER / f"{name}.toml"))
    known = ", ".join(bundled_studies())
    raise ConfigError(f"study '{name}': no such study; expected a .toml file or one of {known}")
