"""The completions for the shell: bundled names, and files where a file is allowed."""

from pathlib import Path


def complete_scenario(incomplete: str) -> list[str]:
    """Return bundled scenarios, and configurations of SUMO."""
    from sumo_scenarios import available

    return _beginning(available(), incomplete) + _files(incomplete, ".sumocfg")


def complete_study(incomplete: str) -> list[str]:
    """Return bundled studies, and definitions of studies."""
    from giveway.studies.study_files import bundled_studies

    return _beginning(bundled_studies(), incomplete) + _files(incomplete, ".toml")


def _beginning(names: list[str] | tuple[str, ...], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _files(incomplete: str, suffix: str) -> list[str]:
    """Return folders and files with that suffix whose path begins with the text."""
    folder, _, start = incomplete.rpartition("/")
    try:
        entries = sorted(Path(f"{folder}/" if folder or incomplete[:1] == "/" else ".").iterdir())
    except OSError:
        return []
    before = incomplete[: len(incomplete) - len(start)]
    return [
        f"{before}{entry.name}" + "/" * entry.is_dir()
        for entry in entries
        if entry.name.startswith(start)
        and (entry.suffix == suffix or (entry.is_dir() and entry.name[0] != "."))
    ]
