"""From import to the first step: python benchmarks/speed/bench_start.py [--rounds N] [--cold].

A run of the default scenario and controller until its first step is done, next to the import of
four libraries that it cannot do without, ``import numba, pandas, libsumo, matplotlib``. Each is a
process of its own; they take turns, so that a busy machine slows both. ``--cold`` also compiles all
kernels into an empty folder, as after installation: elapsed and processor time, of all processes.

Bytecode is kept in a temporary folder, as an installed package has its own.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

FOUR = "import numba, pandas, libsumo, matplotlib"
FIRST_STEP = """
import os
from giveway.api import simulate
from giveway.config.files.layers import Layer
from giveway.config.files.loading import load
from giveway.cosimulation.preflight import preflight
from giveway.precompile import compile_kernels_once

def watch(progress):
    if progress.time > 0:
        raise KeyboardInterrupt  # the first step is done

checked = preflight(*load([Layer("", {"seed": 4})]))
compile_kernels_once()
try:
    simulate(checked, watch)
except KeyboardInterrupt:
    pass
else:
    raise SystemExit("no step was done")
"""
COMPILING = "from giveway.precompile import compile_kernels_once; compile_kernels_once()"


def timed(script: str, environment: dict[str, str]) -> tuple[float, float]:
    """Elapsed and processor time [s] of a script in a process of its own, children included."""
    before = os.times()
    began = perf_counter()
    subprocess.run([sys.executable, "-c", script], env=environment, check=True)
    elapsed, after = perf_counter() - began, os.times()
    user, system = (getattr(after, n) - getattr(before, n) for n in _OF_CHILDREN)
    return elapsed, user + system


_OF_CHILDREN = ("children_user", "children_system")


def measure(rounds: int, *, cold: bool) -> dict[str, float]:
    """The figures of this benchmark, by name; times in seconds."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"PYTHONPYCACHEPREFIX": str(Path(folder) / "bytecode")}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for script in (FOUR, FIRST_STEP):
            timed(script, environment)  # compiles kernels and bytecode, fills the file cache
        pairs = [(timed(FOUR, environment), timed(FIRST_STEP, environment)) for _ in range(rounds)]
        found = {
            "imports": median(four[0] for four, _ in pairs),
            "first step": median(ours[0] for _, ours in pairs),
            "ratio, elapsed": median(ours[0] / four[0] for four, ours in pairs),
            "ratio, processor": median(ours[1] / four[1] for four, ours in pairs),
        }
        if cold:
            empty = environment | {"NUMBA_CACHE_DIR": str(Path(folder) / "kernels")}
            found["cold, elapsed"], found["cold, processor"] = timed(COMPILING, empty)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--cold", action="store_true", help="compile all kernels, too")
    options = parser.parse_args()
    found = measure(options.rounds, cold=options.cold)
    print(f"{'four imports':30} {found['imports']:.2f} s")
    print(f"{'import to first step':30} {found['first step']:.2f} s")
    print(f"{'ratio, elapsed':30} {found['ratio, elapsed']:.2f}")
    print(f"{'ratio, processor time':30} {found['ratio, processor']:.2f}")
    if options.cold:
        elapsed, processor = found["cold, elapsed"], found["cold, processor"]
        print(f"{'compiling all kernels':30} {elapsed:.1f} s, {processor:.1f} s of processor time")


if __name__ == "__main__":
    main()
