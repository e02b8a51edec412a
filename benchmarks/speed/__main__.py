"""Run every benchmark in turn: ``python benchmarks/speed``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def main() -> int:
    """Print each benchmark's table under its name; the exit code is the worst."""
    worst = 0
    for script in sorted(Path(__file__).parent.glob("bench_*.py")):
        print(f"== {script.stem}", flush=True)
        worst = max(worst, abs(subprocess.run([sys.executable, script], check=False).returncode))
    return worst


if __name__ == "__main__":
    sys.exit(main())
