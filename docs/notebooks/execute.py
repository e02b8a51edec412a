"""Execute the notebooks by Jupyter: ``python docs/notebooks/execute.py [NAME ...]``.

The notebooks are stored without outputs, so that none can become old. Each is executed in an empty
folder, by the Python that runs this program. A table with the last line that each one prints is the
measured block of docs/notebooks.md. ``--keep FOLDER`` leaves the executed notebooks there.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tutorials"))

from run import surroundings  # noqa: E402

LONGEST = 300  # Longest time [s] of one cell
KERNEL = "this-python"


def notebooks() -> list[str]:
    """Return the names of the notebooks."""
    return sorted(file.stem for file in HERE.glob("*.ipynb"))


def execute(name: str, folder: Path) -> nbformat.NotebookNode:
    """Execute a notebook in a folder, and return it with its outputs.

    Raises:
        CellExecutionError: A cell fails.
    """
    notebook = nbformat.read(HERE / f"{name}.ipynb", as_version=4)
    kernels = folder / ".jupyter" / "kernels" / KERNEL
    kernels.mkdir(parents=True)
    words = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    spec = {"argv": words, "display_name": KERNEL, "language": "python"}
    (kernels / "kernel.json").write_text(json.dumps(spec), encoding="utf-8")
    variables = surroundings(folder)
    Path(variables["PIP_TARGET"]).mkdir()  # Python remembers folders that are not there
    os.environ |= variables | {"JUPYTER_PATH": str(folder / ".jupyter")}
    where = {"metadata": {"path": str(folder)}}
    NotebookClient(notebook, timeout=LONGEST, kernel_name=KERNEL, resources=where).execute()
    return notebook


def last_line(notebook: nbformat.NotebookNode) -> str:
    """Return the last line that a notebook prints."""
    printed = [
        output.text
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if output.output_type == "stream" and output.name == "stdout"
    ]
    return "".join(printed).rstrip().rpartition("\n")[2]


def main() -> int:
    """Execute the notebooks that are named, or all, and print their last lines as a table."""
    parser = argparse.ArgumentParser(description="Execute the notebooks.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(notebooks()))
    parser.add_argument("--keep", type=Path, help="folder in which the executed notebooks stay")
    arguments = parser.parse_args()
    print("| notebook | its last line |\n|---|---|")
    for name in arguments.names or notebooks():
        with tempfile.TemporaryDirectory() as scratch:
            try:
                executed = execute(name, Path(scratch))
            except CellExecutionError as error:
                print(f"{name}.ipynb: {error}", file=sys.stderr)
                return 1
            if arguments.keep:
                arguments.keep.mkdir(parents=True, exist_ok=True)
                nbformat.write(executed, arguments.keep / f"{name}.ipynb")
        print(f"| [{name}](notebooks/{name}.ipynb) | {last_line(executed)} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
