"""Build the road networks of the scenario folders from their sources, with netconvert.

``python -m sumo_scenarios.build [NAME ...] [--out DIR]`` runs netconvert on the ``<name>.netccfg``
of each folder; a NAME may also be the path of a folder of your own. The same sources and the same
netconvert give the same bytes: netconvert's header, which holds the date and the paths, is replaced
by a line that says where the file comes from.
"""

import argparse
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from sumo_scenarios.catalogue import available, find
from sumo_scenarios.errors import BuildError, ScenarioError

_HOME = "SUMO_HOME"
_DEBIAN = Path("/usr/share/sumo")  # Folder of the tools and data of a Debian package
_HEADER = re.compile(r"<!-- generated on .*?-->", re.DOTALL)


def build(name: str, out: Path | None = None) -> Path:
    """Build the network of one scenario.

    Args:
        name: Name of a bundled scenario, or a folder, as for `find`.
        out: Folder for the file; by default the scenario's own.

    Returns:
        The path of the ``.net.xml`` written.

    Raises:
        ScenarioError: there is no such scenario.
        BuildError: netconvert is not installed, or refused the sources; its reason is included.
    """
    scenario = find(name)
    network = scenario.folder / f"{scenario.name}.net.xml"
    with tempfile.TemporaryDirectory() as scratch:
        raw = Path(scratch) / network.name
        _run_netconvert(scenario.folder / f"{scenario.name}.netccfg", raw)
        text = raw.read_text(encoding="utf-8")
    target = network if out is None else out / network.name
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(_without_date(text, scenario.name), encoding="utf-8", newline="\n")
    return target


def _run_netconvert(config: Path, output: Path) -> None:
    if not config.is_file():
        raise BuildError(
            f"{config} is missing: it names the node and edge files that netconvert is to read"
        )
    result = convert(["-c", str(config), "--output-file", str(output)])
    if result.returncode != 0 or not output.is_file():
        reason = " ".join(result.stderr.split())
        raise BuildError(
            f"netconvert refused {config}: {reason or f'exit code {result.returncode}'}"
        )
    sys.stderr.write(result.stderr)  # warnings that the author has to judge


def convert(words: Sequence[str], typemaps: Sequence[str] = ()) -> subprocess.CompletedProcess[str]:
    """Run netconvert with some options.

    Args:
        words: Options.
        typemaps: Files of SUMO's folder ``data/typemap``, from which it takes types of edges.

    Raises:
        BuildError: there is no netconvert, it cannot be run, or it lacks its files.
    """
    program, home = netconvert_and_home()
    if typemaps:
        folder = home / "data" / "typemap"
        if not folder.is_dir():
            raise BuildError(
                f"{folder}: no such folder; set SUMO_HOME to that of {program}, or pip install "
                "'giveway[new]'"
            )
        words = [*words, "--type-files", ",".join(str(folder / name) for name in typemaps)]
    environment = os.environ | {"SUMO_HOME": str(home)}
    try:
        return subprocess.run(
            [program, *words], capture_output=True, text=True, check=False, env=environment
        )
    except OSError as error:
        raise BuildError(f"netconvert cannot be run: {error}; reinstall 'giveway[new]'") from error


def netconvert_and_home() -> tuple[Path, Path]:
    """Return the program netconvert, and the folder with SUMO's tools and data.

    Those of the eclipse-sumo wheel, whose version the extra ``new`` bounds, come before those of
    ``SUMO_HOME`` and of the search path.

    Raises:
        BuildError: there is no netconvert.
    """
    package = importlib.util.find_spec("sumo")
    homes = [] if package is None or package.origin is None else [Path(package.origin).parent]
    homes += [Path(os.environ[_HOME])] if os.environ.get(_HOME) else []
    for home in homes:
        if found := shutil.which("netconvert", path=home / "bin"):
            return Path(found), home
    if found := shutil.which("netconvert"):
        program = Path(found)
        homes += [program.resolve().parents[1], _DEBIAN]
        return program, next((home for home in homes if (home / "data").is_dir()), homes[0])
    raise BuildError("netconvert is missing: pip install 'giveway[new]', or set SUMO_HOME")


def _without_date(network: str, name: str) -> str:
    """Replace netconvert's header, which differs on every day and machine."""
    origin = f"<!-- built from {name}.netccfg by python -m sumo_scenarios.build {name} -->"
    text, replaced = _HEADER.subn(lambda _: origin, network, count=1)
    if replaced != 1:
        raise BuildError(
            f"{name}.net.xml: netconvert's header was not recognised; is this SUMO 1.28?"
        )
    return text if text.endswith("\n") else text + "\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Build the named scenarios, or all of them; print the path of each network."""
    parser = argparse.ArgumentParser(
        prog="python -m sumo_scenarios.build",
        description="Build the road networks of the bundled scenarios with netconvert.",
    )
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"default: {' '.join(available())}"
    )
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="default: each scenario's own folder"
    )
    options = parser.parse_args(arguments)
    try:
        for name in options.names or available():
            sys.stdout.write(f"{build(name, options.out)}\n")
    except (ScenarioError, OSError) as error:
        sys.stderr.write(f"error: {error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
