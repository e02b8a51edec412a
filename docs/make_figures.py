"""Make the pictures of README and docs anew: ``python docs/make_figures.py [NAME ...]``.

``figures/records.toml`` has a record for each: the commands, the file that becomes the picture,
and the tables that it shows. Without names all are made but the slow ones (``--slow``: those too).
Each is written with the commit, the hash of the picture and the hashes of its tables, so that
``--check``, which makes everything in a scratch folder and writes nothing, tells whose numbers
have changed since. The pictures themselves depend on the version of the library that draws them.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import tomlkit

ROOT = Path(__file__).resolve().parents[1]
FIGURES = ROOT / "docs" / "figures"
RECORDS = FIGURES / "records.toml"


def sha256(file: Path) -> str:
    """The hash of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def commit() -> str:
    """The last commit that changed the code, marked if what is there differs from it."""
    words = ["git", "-C", str(ROOT)]
    code = ["giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios"]
    last = subprocess.run(
        [*words, "log", "-1", "--abbrev=10", "--format=%h", "--", *code],
        capture_output=True,
        text=True,
        check=True,
    )
    same = subprocess.run([*words, "diff", "--quiet", "HEAD", "--", *code], check=False)
    return last.stdout.strip() + ("" if same.returncode == 0 else "+changes")


def run(command: str, folder: Path) -> None:
    """Run a command as it is recorded; ``{root}`` is the repository."""
    first = str(Path(sys.executable).parent)
    environment = os.environ | {
        "PATH": os.pathsep.join([first, os.environ["PATH"]]),
        "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]),
    }
    done = subprocess.run(
        ["bash", "-eu", "-c", command.replace("{root}", str(ROOT))],
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"{command}: exit code {done.returncode}\n{done.stdout}")


def make(record: dict[str, Any], folder: Path, made: set[str]) -> tuple[Path, dict[str, str]]:
    """Run what a record says, if it has not been run yet: its picture, its tables' hashes."""
    for command in record["commands"]:
        if command not in made:
            print(f"  {command}", flush=True)
            run(command, folder)
            made.add(command)
    return folder / record["made"], {name: sha256(folder / name) for name in record["data"]}


def main() -> int:
    """Make what is asked for."""
    parser = argparse.ArgumentParser(description="Make the pictures of README and docs anew.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="pictures, as top_view")
    parser.add_argument(
        "--slow", action="store_true", help="those too that take more than a minute"
    )
    parser.add_argument("--check", action="store_true", help="write nothing; compare the tables")
    arguments = parser.parse_args()
    records = tomlkit.parse(RECORDS.read_text(encoding="utf-8"))
    if strange := sorted(set(arguments.names) - set(records)):
        parser.error(f"no record of {strange[0]!r}: there are {', '.join(records)}")
    wanted = arguments.names or [
        name for name, record in records.items() if arguments.slow or not record.get("slow")
    ]
    differing = 0
    made: set[str] = set()
    with tempfile.TemporaryDirectory() as temporary:
        for name in wanted:
            print(name, flush=True)
            record: Any = records[name]
            picture, data = make(record, Path(temporary), made)
            if changed := [file for file in data if record["data"][file] != data[file]]:
                print(f"  other numbers than recorded: {', '.join(changed)}")
                differing += 1
            if arguments.check:
                continue
            kept = FIGURES / f"{name}{picture.suffix}"
            shutil.copyfile(picture, kept)
            record["data"].update(data)
            record["sha256"] = sha256(kept)
            record["commit"] = commit()
            RECORDS.write_text(tomlkit.dumps(records), encoding="utf-8")
    return 1 if arguments.check and differing else 0


if __name__ == "__main__":
    sys.exit(main())
