"""docs/install.md: what is asked for, what it is for, and what can be taken away again."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
MODULES = {"rpds-py": "rpds", "jsonschema-specifications": "jsonschema_specifications"}
DRIVE = """
import sys
for module in sys.argv.pop(1).split(","):
    sys.modules[module] = None  # importing it is an error
import giveway
result = giveway.run({"scenario": "shared_space", "time_limit": 2.0, "crowd.pedestrians": 3})
print(result.ending, len(result.ego))
"""


def test_every_dependency_has_its_cost() -> None:
    table = PAGE.partition("<!-- evidence: dependencies -->")[2].partition("<!-- end")[0]
    named = re.findall(r"^\| ([a-z0-9-]+) \| [\d.]+ \|", table, re.MULTILINE)
    asked = [Requirement(text).name for text in PROJECT["dependencies"]]
    assert sorted(named) == sorted(asked)
    assert all(row.count("|") == 6 and not row.endswith("|  |") for row in table.splitlines()[4:-2])


def test_every_extra_is_explained() -> None:
    named = set(re.findall(r"`(\w+)`", PAGE.partition("## Extras")[2].partition("<!--")[0]))
    assert set(PROJECT["optional-dependencies"]) <= named


def test_a_drive_needs_nothing_of_what_may_be_taken_away() -> None:
    found = re.search(r"pip uninstall --yes (.+)", PAGE)
    assert found is not None
    modules = [MODULES.get(name, name.replace("-", "_")) for name in found[1].split()]
    assert len(modules) > 5
    done = subprocess.run(
        [sys.executable, "-c", DRIVE, ",".join(modules)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["time", "limit", "41"]  # t = 0 included
