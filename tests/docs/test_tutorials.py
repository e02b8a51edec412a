"""The tutorials, and what runs them as they are printed."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parents[2] / "docs" / "tutorials"


@pytest.fixture
def runner(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The runner, whose pages are in a folder of the test."""
    spec = importlib.util.spec_from_file_location("tutorials_run", FOLDER / "run.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    (tmp_path / "pages").mkdir()
    (tmp_path / "work").mkdir()
    monkeypatch.setattr(module, "HERE", tmp_path / "pages")
    return module


def test_six_tutorials_are_listed_and_there(runner: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "HERE", FOLDER)
    names = runner.tutorials()
    pages = {page.stem for page in FOLDER.glob("*.md")} - {"index"}
    assert len(names) == 6
    assert set(names) == pages


def test_every_tutorial_runs_something_and_shows_its_result(runner: Any) -> None:
    for page in FOLDER.glob("*.md"):
        if page.stem == "index":
            continue
        found = list(runner.blocks(page.read_text(encoding="utf-8")))
        assert any(block.language == "sh" and not block.mark for block in found), page
        assert any(block.mark == "prints" for block in found), page


def play(runner: Any, tmp_path: Path, page: str) -> None:
    (tmp_path / "pages" / "made.md").write_text(page, encoding="utf-8")
    runner.play("made", tmp_path / "work", show=False)


PAGE = """# Made

<!-- file: inner/square.py -->
```python
print("the square of 7 is", 7 * 7)
```

```python
import runpy

runpy.run_path("inner/square.py")
```

<!-- prints -->
```text
...
the square of 7   is ...
```
"""


def test_a_page_does_what_it_says(runner: Any, tmp_path: Path) -> None:
    play(runner, tmp_path, PAGE)
    assert (tmp_path / "work" / "inner" / "square.py").is_file()


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("is ...", "is 50", r"made\.md, line 15: not printed: 'the square of 7   is 50'"),
        ('"inner/', '"other/', r"made\.md, line 8: exit code 1"),
        ("7 is", "8 is", "not printed"),
    ],
)
def test_a_page_that_does_not_is_refused(
    runner: Any, tmp_path: Path, old: str, new: str, complaint: str
) -> None:
    with pytest.raises(runner.TutorialError, match=complaint):
        play(runner, tmp_path, PAGE.replace(old, new, 1))


def test_a_mark_without_a_block_is_refused(runner: Any, tmp_path: Path) -> None:
    with pytest.raises(runner.TutorialError, match="no block follows"):
        play(runner, tmp_path, "<!-- prints -->\nwords\n")


def test_what_is_installed_goes_into_the_folder(runner: Any, tmp_path: Path) -> None:
    variables = runner.surroundings(tmp_path)
    assert variables["PIP_TARGET"].startswith(str(tmp_path))
    assert variables["PYTHONPATH"].split(":")[0].split(";")[0] == variables["PIP_TARGET"]


def test_the_extract_says_whose_it_is() -> None:
    head = (FOLDER / "helsinki.osm").read_text(encoding="utf-8")[:600]
    assert 'copyright="OpenStreetMap and contributors"' in head
    assert "opendatacommons.org/licenses/odbl" in head
    page = re.sub(r"\s+", " ", (FOLDER / "openstreetmap.md").read_text(encoding="utf-8"))
    assert "© OpenStreetMap contributors, available under the [Open Database Licence]" in page
