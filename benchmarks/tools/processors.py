"""Whether runs have the same bytes on other processors: ``python benchmarks/tools/processors.py``.

Each run of :data:`RUNS` is repeated as other processors would make it, with the kernels that this
one has: BLAS for other cores, numpy without its newer vector units, numba's code for an older
processor, and a C library without fused multiplication. Each line names the columns that differ.
The last one is told, not promised (docs/results.md): such processors are older than 2013.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import fingerprints

RUNS: dict[str, dict[str, Any]] = {
    "junction --seed 24": {"scenario": "junction", "seed": 24},
    **fingerprints.RUNS,
}
NEWEST = "X86_V4 AVX512_ICL"  # numpy's names of what has AVX-512
#: What is set in the environment to drive as another processor would.
PROCESSORS: dict[str, dict[str, str]] = {
    "BLAS for SkylakeX": {"OPENBLAS_CORETYPE": "SkylakeX"},
    "BLAS for Haswell": {"OPENBLAS_CORETYPE": "Haswell"},
    "BLAS for Sandybridge": {"OPENBLAS_CORETYPE": "Sandybridge"},
    "BLAS for Prescott": {"OPENBLAS_CORETYPE": "Prescott"},
    "numpy without AVX-512": {"NPY_DISABLE_CPU_FEATURES": NEWEST},
    "numpy without AVX2": {"NPY_DISABLE_CPU_FEATURES": f"X86_V3 {NEWEST}"},
    "numba for x86-64-v3": {"NUMBA_CPU_NAME": "x86-64-v3", "NUMBA_CPU_FEATURES": ""},
    "C library without FMA": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F"},
}
NOT_PROMISED = "C library without FMA"


def compared(name: str, processors: list[str]) -> int:
    """Print how a run differs on each processor; return on how many of those promised it does."""
    here = fingerprints.in_a_process(name)
    differ = 0
    for processor in processors:
        there = fingerprints.in_a_process(name, PROCESSORS[processor])
        different = [column for column in here if here[column] != there.get(column)]
        differ += bool(different) and processor != NOT_PROMISED
        verdict = f"DIFFERS: {', '.join(different)}" if different else f"{len(here)} columns equal"
        print(f"{name:30} {processor:24} {there.get('failed') or verdict}", flush=True)
    return differ


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", action="append", choices=RUNS, help="some of the runs")
    parser.add_argument("--processor", action="append", choices=PROCESSORS, help="some of them")
    options = parser.parse_args()
    fingerprints.RUNS.update(RUNS)
    differ = sum(
        compared(name, options.processor or list(PROCESSORS)) for name in options.only or RUNS
    )
    print(f"{differ} of the promised comparisons differ")
    sys.exit(bool(differ))


if __name__ == "__main__":
    main()
