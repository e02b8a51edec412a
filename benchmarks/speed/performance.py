"""Ratios of times next to the kept ones: python benchmarks/speed/performance.py --quick.

``--quick`` takes a few ratios in short runs and shows them next to the kept ones
(kept_ratios.json); ``--keep`` keeps them. The exit code never depends on a time. ``--machine``
prints with what docs/performance.md is made, ``python benchmarks/evidence performance``.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import subprocess
import sys
from datetime import date
from importlib.metadata import version
from pathlib import Path

from giveway.results.provenance import processor

HERE = Path(__file__).resolve().parent
KEPT = HERE / "kept_ratios.json"
TOLERANCE = 1.6  # times the kept ratio, either way: another machine, and a busy one
PACKAGES = ("numpy", "numba", "llvmlite", "osqp", "libsumo", "fmpy", "pandas")
#: Short runs, and where their ratios stand in what they print.
QUICK = {
    "bench_loop.py --seeds 4": r"^(?P<name>[\w-]+), 30 .*\n.*moves and steps.*: (?P<ratio>[\d.]+)",
    "bench_fmu.py --ticks 1000 --rounds 5": r"^(?P<name>FMI \d\.0) .*us +(?P<ratio>[\d.]+)$",
    "bench_start.py --rounds 3": r"^(?P<name>ratio, \w+).* (?P<ratio>[\d.]+)$",
    "bench_study.py --runs 10 --crowds 6": r"^ *(?P<name>mpc over \S+): +(?P<ratio>[\d.]+)",
}


def printed(command: str) -> str:
    """What a benchmark prints.

    Raises:
        CalledProcessError: it has failed.
    """
    script, *words = command.split()
    done = subprocess.run(
        [sys.executable, HERE / script, *words], stdout=subprocess.PIPE, text=True, check=True
    )
    return done.stdout.rstrip("\n")


def machine() -> str:
    """One sentence about where and with what the numbers were made."""
    name = processor()["name"]
    versions = ", ".join(f"{package} {version(package)}" for package in PACKAGES)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    return (
        f"{date.today().isoformat()}: {name}, {os.cpu_count()} processors{load}; "
        f"{platform.system()}, Python {platform.python_version()}, {versions}."
    )


def ratios() -> dict[str, float]:
    """The ratios of the short runs, by benchmark and name."""
    found = {}
    for command, pattern in QUICK.items():
        for match in re.finditer(pattern, printed(command), re.MULTILINE):
            found[f"{command.split()[0]} {match['name']}"] = float(match["ratio"])
    return found


def compared(now: dict[str, float], kept: dict[str, float]) -> list[str]:
    """A line for each ratio; those far from the kept ones are marked."""
    lines = [f"{'':45}{'kept':>8}{'now':>8}"]
    for name in sorted(now | kept):
        old, new = kept.get(name), now.get(name)
        shown = "".join(f"{'-' if x is None else f'{x:.2f}':>8}" for x in (old, new))
        far = old and new and not old / TOLERANCE <= new <= old * TOLERANCE
        lines.append(f"{name:45}{shown}" + (f"   more than {TOLERANCE:g} times apart" * bool(far)))
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    choice = parser.add_mutually_exclusive_group(required=True)
    choice.add_argument("--quick", action="store_true", help="a few ratios next to the kept ones")
    choice.add_argument("--keep", action="store_true", help="keep these ratios")
    choice.add_argument("--machine", action="store_true", help="processor and versions")
    options = parser.parse_args()
    if options.machine:
        print(machine())
        return
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    now = ratios()
    print("\n".join(compared(now, kept)))
    if options.keep:
        KEPT.write_text(json.dumps(now, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
