"""An hour with a thousand walkers: memory, size of the trajectories, and size of the journal.

    python benchmarks/speed/an_hour.py --out FOLDER [--seconds 3600] [--only CASE]

An open plaza is built on the spot, over which 1,000 people walk by the VCI model for the whole
time, without an ego (recorded at every control step of 0.05 s) or beside one (recorded as by
default). Both run as a user types it, and the memory of all processes is added up ten times a
second. "forms" is a minute in which SUMO writes its own FCD of the same people at all instants.
What is in FOLDER already is not run again. The exit code is 1 if a bar is missed: 1 GiB of memory,
and twice the size of SUMO's fcd.xml.gz.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import sumo

MEMORY = 2.0**30  # [bytes] bar
RATIO = 2.0  # bar: size of a form over that of SUMO's FCD
PEOPLE = 1_000
WAY = 9_000.0  # [m] length of the plaza; nobody arrives within an hour
NODES = f"""<nodes><node id="west" x="-20" y="0"/><node id="east" x="{WAY}" y="0"/></nodes>"""
EDGES = """<edges><edge id="plaza" from="west" to="east" numLanes="1" speed="14"
 sidewalkWidth="2"/></edges>"""
SETTINGS = f"""
seed = 1
controller = "pid-tuned"
[ego]
route = ["plaza"]
[regulation]
reference_speed = 1.4
[crowd]
pedestrians = {PEOPLE}
spawn_area = [0.0, 10.0, 400.0, 410.0]
walk = [8000.0, 0.0]
zone = "none"
"""
CASES: dict[str, tuple[str, ...]] = {
    "without an ego": ("--no-ego", "--trajectories", "parquet"),
    "one ego": ("--trajectories", "parquet"),
    "forms": ("--no-ego", "--trajectories", "csv.gz", "--parquet", "--no-pictures"),
}


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seconds", type=float, default=3600.0, help="scenario time of the hour")
    parser.add_argument("--only", choices=list(CASES))
    asked = parser.parse_args()
    missed = False
    for name in [asked.only] if asked.only else CASES:
        seconds = 60.0 if name == "forms" else asked.seconds
        told = asked.out / f"{name.replace(' ', '_')}_{seconds:g}.json"
        if not told.exists():
            asked.out.mkdir(parents=True, exist_ok=True)
            told.write_text(json.dumps(measured(name, seconds, asked.out / told.stem)))
        found = json.loads(told.read_text())
        print(f"{name}, {seconds:g} s: " + ", ".join(f"{k} {v:,}" for k, v in found.items()))
        missed |= found["memory [MiB]"] * 2**20 > MEMORY
        missed |= any(value > RATIO for key, value in found.items() if key.endswith("over FCD"))
    return int(missed)


def measured(case: str, seconds: float, folder: Path) -> dict[str, float]:
    """Run a case as a user does, and return its memory, time and sizes."""
    scenario = build(folder / "scenario", fcd=case == "forms")
    out = folder / "results"
    command = [sys.executable, "-m", "giveway", "run", str(scenario), "--quiet", "--force"]
    command += ["--time-step", "0.05", "--time-limit", f"{seconds:g}", "--out", str(out)]
    began = time.monotonic()
    peak, journal = watched([*command, *CASES[case]])
    rows = json.loads((out / "manifest.json").read_text())["pedestrians"]
    found: dict[str, float] = {
        "memory [MiB]": round(peak / 2**20),
        "people": rows["added"],
        "wall clock [s]": round(time.monotonic() - began),
        "journal [MB]": round(journal / 1e6),
    }
    sizes = {file.name: file.stat().st_size for file in out.glob("trajectories.*")}
    found |= {f"{name} [MB]": round(size / 1e6) for name, size in sizes.items()}
    if case == "forms":
        own = (out / "sumo" / "fcd.xml.gz").stat().st_size
        found |= {f"{name} over FCD": round(size / own, 2) for name, size in sizes.items()}
    return found


def build(folder: Path, *, fcd: bool) -> Path:
    """Build the plaza; SUMO's step is 1 s, and the control step if it is to write its FCD."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "plaza.nod.xml").write_text(NODES)
    (folder / "plaza.edg.xml").write_text(EDGES)
    program = Path(sumo.SUMO_HOME) / "bin" / "netconvert"
    files = ["-n", "plaza.nod.xml", "-e", "plaza.edg.xml", "-o", "plaza.net.xml"]
    subprocess.run([program, *files], cwd=folder, check=True, capture_output=True)
    output = '<output><fcd-output value="fcd.xml.gz"/></output>' if fcd else ""
    (folder / "plaza.sumocfg").write_text(
        f"""<configuration><input><net-file value="plaza.net.xml"/></input>{output}<time>
        <end value="4000"/><step-length value="{0.05 if fcd else 1.0}"/></time></configuration>"""
    )
    (folder / "plaza.giveway.toml").write_text(SETTINGS)
    return folder


def watched(command: list[Any]) -> tuple[int, int]:
    """Run a command; return the most memory of its processes together, and of its journal [bytes].

    Raises:
        CalledProcessError: it failed.
    """
    process = subprocess.Popen(command)
    memory = journal = 0
    while process.poll() is None:
        each = [process.pid]
        for pid in each:
            each += children(pid)
        memory = max(memory, sum(map(resident, each)))
        journal = max([journal, *map(journalled, each)])
        time.sleep(0.1)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return memory, journal


def children(pid: int) -> list[int]:
    """Return the children of a process."""
    try:
        tasks = Path(f"/proc/{pid}/task").glob("*/children")
        return [int(child) for task in tasks for child in task.read_text().split()]
    except OSError:
        return []


def resident(pid: int) -> int:
    """Return the resident memory of a process [bytes]; 0 if it has ended."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return 0
    return sum(1024 * int(line.split()[1]) for line in lines if line.startswith("VmRSS"))


def journalled(pid: int) -> int:
    """Return the size of the journal that a process writes [bytes]; 0 without one."""
    try:
        files = [file.resolve() for file in Path(f"/proc/{pid}/fd").iterdir()]
        return max((f.stat().st_size for f in files if f.name == "rows"), default=0)
    except OSError:
        return 0


if __name__ == "__main__":
    sys.exit(main())
