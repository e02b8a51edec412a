"""Do the tests of a room find small faults in it? A seeded sample of Cosmic Ray's mutants tells.

Run: pip install cosmic-ray
     python benchmarks/tools/mutation.py controller/pid tests/controller/pid --sample 60 --seed 1

The faults are made in a copy of the last commit. A kernel with a fault is compiled anew, since the
cache of kernels goes by their content. The exit code is 1 if any fault is not found.
"""

from __future__ import annotations

import argparse
import os
import random
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2]
SESSION = "session.sqlite"
CONFIG = """[cosmic-ray]
module-path = "{room}"
timeout = {limit}
excluded-modules = []
test-command = "{python} -m pytest -x -q {tests}"
[cosmic-ray.distributor]
name = "local"
"""


def draw_sample(session: Path, size: int, seed: int) -> int:
    """Keep a sample of a session's mutants; the number of those that are kept."""
    with sqlite3.connect(session) as base:
        order = "module_path, start_pos_row, start_pos_col, operator_name, occurrence"
        specs = base.execute(f"SELECT job_id FROM mutation_specs ORDER BY {order}")
        jobs = [job for (job,) in specs]
        kept = set(random.Random(seed).sample(jobs, min(size, len(jobs))))
        gone = [(job,) for job in jobs if job not in kept]
        base.executemany("DELETE FROM mutation_specs WHERE job_id = ?", gone)
        base.executemany("DELETE FROM work_items WHERE job_id = ?", gone)
    return len(kept)


def survivors(session: Path) -> list[str]:
    """Differences of the mutants that no test has found."""
    with sqlite3.connect(session) as base:
        found = base.execute("SELECT diff FROM work_results WHERE test_outcome = 'SURVIVED'")
        return [diff for (diff,) in found]


def main() -> int:
    """Make the mutants, run the tests on each and print what they did not find."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("room", help="folder or file that gets the faults")
    parser.add_argument("tests", help="tests that are to find them")
    parser.add_argument("--sample", type=int, default=60, help="number of mutants")
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample")
    parser.add_argument("--limit", type=float, default=300.0, help="time for one mutant [s]")
    parser.add_argument("--cosmic-ray", default="cosmic-ray", help="its command")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        packed = tree / "tree.tar"
        git = ["git", "-C", str(HOUSE), "archive", "-o", str(packed), "HEAD"]
        subprocess.run(git, check=True)
        subprocess.run(["tar", "-xf", packed, "-C", tree], check=True)
        words = {"room": options.room, "tests": options.tests, "limit": options.limit}
        text = CONFIG.format(**words, python=sys.executable)
        (tree / "session.toml").write_text(text, encoding="utf-8")
        run = {"cwd": tree, "check": True, "env": os.environ | {"PYTHONPATH": folder}}
        subprocess.run([options.cosmic_ray, "init", "session.toml", SESSION], **run)
        subprocess.run([options.cosmic_ray, "baseline", "session.toml"], **run)
        count = draw_sample(tree / SESSION, options.sample, options.seed)
        subprocess.run([options.cosmic_ray, "exec", "session.toml", SESSION], **run)
        left = survivors(tree / SESSION)
    print("\n".join(left))
    print(f"{count} faults in {options.room}: the tests find {count - len(left)}")
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
