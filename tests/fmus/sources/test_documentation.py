"""The worked examples of docs/controller_fmu.md run as they stand and stop where they say."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "docs" / "controller_fmu.md"
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


@pytest.mark.parametrize("number", range(2))
def test_an_example_stops_short_of_the_safe_distance(number: int, tmp_path: Path) -> None:
    code = EXAMPLES[number]
    if "libcosimpy" in code and importlib.util.find_spec("libcosimpy") is None:
        pytest.skip("not installed: pip install libcosimpy")
    file = tmp_path / "example.py"
    file.write_text(code, "utf-8")
    done = subprocess.run(
        [sys.executable, file], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    found = re.search(r"stands ([\d.]+) m before, at 0.00 m/s", done.stdout)
    assert found is not None, done.stdout
    assert 8.0 <= float(found[1]) < 8.3


def test_there_are_no_other_examples() -> None:
    assert len(EXAMPLES) == 2
