"""The sha256 of each column of ten fixed runs: a change that only moves code changes none of them.

Run: python benchmarks/tools/fingerprints.py --write before.json
     python benchmarks/tools/fingerprints.py --compare before.json [--only NAME]

Each run is a process of its own, and only public names are used, so that two states of the
repository can be compared:
``PYTHONPATH=OTHER_CHECKOUT python benchmarks/tools/fingerprints.py ...``. ``timing.csv``
is left out: it holds computing times. A column that is new is named and is no difference.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

AS_IT_IS: Mapping[str, str] = MappingProxyType({})
SEVERAL_EGOS = [
    {"ego": {"take_over": ["westbound.0"]}, "controller": "pid-tuned"},
    {"ego": {"take_over": ["eastbound.0"]}, "controller": "mpc-paper"},
    {"ego": {"id": "shuttle", "depart_time": 8.0}},
]
SLOWLY = {"reference_speed": 4.0}  # as before lanes said how fast: older states are comparable
#: What is run: four controllers, three scenarios, SUMO steps of 1 s, 0.1 s and 0.05 s, several
#: egos, an FMU that is not ours, walkers that are taken over, walls, noise, exact integration.
RUNS: dict[str, dict[str, Any]] = {
    "mpc": {"crowd": {"pedestrians": 30}, "seed": 13},
    "pid-tuned": {"controller": "pid-tuned", "crowd": {"pedestrians": 30, "two_sided": True}},
    "mpc-paper": {"controller": "mpc-paper", "crowd": {"pedestrians": 30}, "seed": 3},
    "pid-paper": {
        "controller": "pid-paper",
        "crowd": {"pedestrians": 60},
        "vehicle": {"fmu": "fmi3-exact"},
        "seed": 2,
    },
    "street, SUMO steps of 1 s": {
        "scenario": "street",
        "crowd": {"pedestrians": 20},
        "regulation": SLOWLY,
        "sumo": {"step_length": 1.0},
    },
    "street, SUMO steps of 0.05 s": {
        "scenario": "street",
        "controller": "mpc-paper",
        "crowd": {"pedestrians": 20},
        "sumo": {"step_length": 0.05},
    },
    "junction, walls": {
        "scenario": "junction",
        "crowd": {"walls": True},
        "regulation": SLOWLY,
        "time_limit": 25.0,
    },
    "junction, several egos": {
        "scenario": "junction",
        "egos": SEVERAL_EGOS,
        "crowd": {"zone": "everywhere"},
        "regulation": SLOWLY,
        "time_limit": 40.0,
    },
    "an FMU that is not ours": {"crowd": {"pedestrians": 20}, "vehicle": {"fmu": "FOREIGN"}},
    "noise": {
        "crowd": {"pedestrians": 20, "two_sided": True},
        "perception": {"position_noise": 0.1, "preset": "TABLE2"},
        "seed": 5,
    },
}


def fingerprint(run: dict[str, Any]) -> dict[str, str]:
    """The sha256 of each column that a run leaves, by its file's name and its own."""
    import fmus
    import giveway

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        settings = {"record": {"predictions": 0.5}, **run}
        if settings.get("vehicle", {}).get("fmu") == "FOREIGN":
            settings["vehicle"]["fmu"] = str(_foreign(fmus.bundled_fmu("2.0"), folder))
        giveway.run(settings, results=folder / "run", pictures=False)
        return {
            f"{file.name} {column}": hashlib.sha256("\n".join(values).encode()).hexdigest()
            for file in sorted((folder / "run").glob("*.csv"))
            if file.name != "timing.csv"
            for column, values in _columns(file).items()
        }


def _columns(file: Path) -> dict[str, list[str]]:
    """The columns of a table as it is written, by their names."""
    with file.open(encoding="utf-8", newline="") as text:
        names, *rows = csv.reader(text)
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def _foreign(bundled: Path, folder: Path) -> Path:
    """The bundled FMU packed anew: other bytes, hence somebody else's, isolated and drafted."""
    path = folder / "car.fmu"
    with zipfile.ZipFile(bundled) as ours, zipfile.ZipFile(path, "w") as theirs:
        for name in ours.namelist():
            theirs.writestr(name, ours.read(name))
    return path


def in_a_process(
    name: str, environment: Mapping[str, str] = MappingProxyType({})
) -> dict[str, str]:
    """Return :func:`fingerprint` of a run in a process of its own; "failed" if it ended badly."""
    done = subprocess.run(
        [sys.executable, __file__, "--one", json.dumps(RUNS[name])],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | environment,
    )
    if done.returncode:
        return {"failed": done.stderr.strip().splitlines()[-1]}
    tables: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return tables


def _differences(before: dict[str, str], now: dict[str, str]) -> list[str]:
    return sorted(name for name in before if before[name] != now.get(name))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", type=Path, help="keep the sha256 in this file")
    parser.add_argument("--compare", type=Path, help="a file that --write made")
    parser.add_argument("--only", action="append", choices=RUNS, help="some of the runs")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(fingerprint(json.loads(options.one))))
        return
    before = json.loads(options.compare.read_text()) if options.compare else {}
    found, differ = {}, 0
    for name in options.only or RUNS:
        found[name] = in_a_process(name)
        verdict = found[name].get("failed") or f"{len(found[name])} columns"
        if options.compare:
            different = _differences(before.get(name, {}), found[name])
            differ += bool(different)
            verdict = f"DIFFERS: {', '.join(different)}" if different else "the same bytes"
            new = sorted(found[name].keys() - before.get(name, {}).keys() - {"failed"})
            verdict += f"; new: {', '.join(new)}" if new else ""
            verdict += f" ({found[name]['failed']})" if "failed" in found[name] else ""
        print(f"{name:30} {verdict}", flush=True)
    if options.write:
        options.write.write_text(json.dumps(found, indent=1) + "\n")
    sys.exit(1 if differ else 0)


if __name__ == "__main__":
    main()
