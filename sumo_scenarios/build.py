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
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from sumo_scenarios.catalogue import available, find
from sumo_scenarios.errors import BuildError, ScenarioError

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
    home = _sumo_home()
    command: list[str | Path] = [home / "bin" / "netconvert", "-c", config, "--output-file", output]
    environment = os.environ | {"SUMO_HOME": str(home)}
    try:
        result = subprocess.run(
            command, capture_output=True, text=True, check=False, env=environment
        )
    except OSError as error:
        raise BuildError(
            f"netconvert cannot be run: {error}; reinstall 'giveway[build]'"
        ) from error
    if result.returncode != 0 or not output.is_file():
        reason = " ".join(result.stderr.split())
        raise BuildError(
            f"netconvert refused {config}: {reason or f'exit code {result.returncode}'}"
        )
    sys.stderr.write(result.stderr)  # warnings that the author has to judge


def _sumo_home() -> Path:
    """Find the folder of the eclipse-sumo wheel, whose version the build extra pins."""
    package = importlib.util.find_spec("sumo")
    if package is None or package.origin is None:
        raise BuildError("netconvert is missing: pip install 'giveway[build]'")
    return Path(package.origin).parent


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
