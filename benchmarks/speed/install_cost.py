"""What each dependency costs: python benchmarks/speed/install_cost.py.

From the environment that runs it: the size of what is installed, of what only this dependency
brings along, and the processor time of importing it alone, the median of three fresh processes.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from statistics import median
from typing import Any

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[2]
USED_FOR = {
    "cmaes": "the search of giveway calibrate",
    "contourpy": "contours of the vehicle's influence; comes with matplotlib",
    "filelock": "one process at a time writes a study",
    "fmpy": "calls vehicle FMUs",
    "jinja2": "pages of replays and reports",
    "libsumo": "SUMO, within the process",
    "matplotlib": "pictures",
    "numba": "compiles crowd, planner and metrics",
    "numpy": "arrays",
    "osqp": "the quadratic program of the MPC",
    "packaging": "versions of other people's packages",
    "pandas": "tables",
    "pillow": "GIFs; comes with matplotlib",
    "platformdirs": "where compiled kernels are kept",
    "pydantic": "checks configurations",
    "rich": "tables and progress on the terminal",
    "scipy": "statistics of studies; fitting; sparse matrices of OSQP",
    "shapely": "where people can walk",
    "tomlkit": "writes TOML with its comments",
    "threadpoolctl": "names the kernel of BLAS",
    "typer": "the command line",
}
MODULES = {"pillow": "PIL.Image"}  # that are called otherwise than their package
DEVELOPERS = {"test", "dev", "benchmark"}  # extras that no user needs


def name_of(text: str) -> str:
    """A distribution's name as the index spells it."""
    return re.sub(r"[-_.]+", "-", text).lower()


def needs(name: str) -> set[str]:
    """Everything that is installed for a distribution, itself included."""
    found: set[str] = set()
    waiting: list[tuple[str, frozenset[str]]] = [(name, frozenset())]
    while waiting:
        current, wanted = waiting.pop()
        if current in found:
            continue
        try:
            required = metadata.requires(current) or []
        except metadata.PackageNotFoundError:
            continue
        found.add(current)
        for text in required:
            need = Requirement(text)
            if need.marker is None or any(
                need.marker.evaluate({"extra": extra}) for extra in ("", *wanted)
            ):
                waiting.append((name_of(need.name), frozenset(need.extras)))
    return found


def size(name: str) -> float:
    """Installed megabytes [MB] of a distribution, without what Python has compiled."""
    files = [
        Path(str(metadata.distribution(name).locate_file(file)))
        for file in metadata.files(name) or []
        if file.suffix != ".pyc"
    ]
    return sum(file.stat().st_size for file in files if file.is_file()) / 1e6


def import_time(module: str) -> float:
    """Processor time [s] of importing a module in a fresh process: the median of three."""
    clock = "time.process_time()"
    script = f"import time; began = {clock}; import {module}; print({clock} - began)"
    runs = [
        subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        for _ in range(3)
    ]
    return median(float(run.stdout.split()[-1]) for run in runs)


def table(names: list[str], base: dict[str, set[str]], label: dict[str, str]) -> list[str]:
    """A row per dependency, the largest first: what would leave with it, and its import."""
    rows = []
    for name in names:
        others = set().union(*(needed for other, needed in base.items() if other != name))
        along = sorted(needs(name) - others - {name})
        brings = sum(size(one) for one in along)
        told = f"{brings:.1f} ({', '.join(along)})" if along else ""
        seconds = import_time(MODULES.get(name, name.replace("-", "_")))
        cells = (name, f"{size(name):.1f}", told, f"{seconds:.2f}", label.get(name, ""))
        rows.append((size(name), "| " + " | ".join(cells) + " |"))
    return [row for _, row in sorted(rows, reverse=True)]


def extras_table(project: dict[str, Any], there: set[str]) -> list[str]:
    """A row per extra: what it adds to an environment that has giveway's dependencies."""
    rows = []
    for extra, texts in project["optional-dependencies"].items():
        if extra in DEVELOPERS:
            continue
        names = [name_of(Requirement(text).name) for text in texts]
        names = [name for name in names if name != "giveway"]
        added = set().union(*map(needs, names)) - there
        missing = [name for name in names if not needs(name)]
        megabytes = f"{sum(map(size, added)):.1f}" if not missing else "not installed here"
        rows.append(f"| `{extra}` | {', '.join(names)} | {megabytes} |")
    return rows


def main() -> None:
    """Print the table of the extras and that of the dependencies."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    names = [name_of(Requirement(text).name) for text in project["dependencies"]]
    base = {name: needs(name) for name in names}
    there = set().union(*base.values())
    lines = [
        "| package | MB | only with it, MB | import [s] | what for |",
        "|---|---|---|---|---|",
        *table(names, base, USED_FOR),
        "",
        f"Together {len(there)} packages of {sum(map(size, there)):.0f} MB.",
    ]
    extras = ["| extra | packages | adds, MB |", "|---|---|---|", *extras_table(project, there)]
    print("\n".join([*extras, "---", *lines]))


if __name__ == "__main__":
    main()
