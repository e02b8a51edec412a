"""The notebooks are stored without outputs, run as they stand, and are pages of the site."""

from __future__ import annotations

import json
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))


def test_there_is_one_for_each_door_and_the_page_lists_it() -> None:
    page = (DOCS / "notebooks.md").read_text(encoding="utf-8")
    assert [file.stem for file in NOTEBOOKS] == ["controller", "question", "scenario", "vehicle"]
    assert all(f"](notebooks/{file.name}) | " in page for file in NOTEBOOKS)


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_no_output_is_stored_that_could_become_old(file: Path) -> None:
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code
    assert not any(cell["outputs"] or cell["execution_count"] for cell in code)


def test_cells_become_markdown() -> None:
    pytest.importorskip("myst_parser", reason="myst_parser: giveway[docs] has it")
    pages = runpy.run_path(str(DOCS / "notebook_pages.py"))
    cells = [
        {"cell_type": "markdown", "source": ["# A title\n", "Words."]},
        {"cell_type": "code", "source": ["x = 1\n", "x"]},
        {"cell_type": "code", "source": ["!giveway doctor"]},
    ]
    assert pages["markdown_of"](json.dumps({"cells": cells})) == (
        "# A title\nWords.\n\n```python\nx = 1\nx\n```\n\n```text\n!giveway doctor\n```\n"
    )


def test_a_notebook_is_executed_by_jupyter(tmp_path: Path) -> None:
    pytest.importorskip(
        "hatchling", reason="hatchling: giveway[dev] has it, and builds the plug-in"
    )
    script = DOCS / "notebooks" / "execute.py"
    done = subprocess.run(
        [sys.executable, script, "controller", "--keep", tmp_path],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "| [controller](notebooks/controller.ipynb) | among blind people: " in done.stdout
    executed = json.loads((tmp_path / "controller.ipynb").read_text(encoding="utf-8"))
    tables = [
        output["data"]["text/html"]
        for cell in executed["cells"]
        for output in cell.get("outputs", [])
        if "text/html" in output.get("data", {})
    ]
    assert tables
