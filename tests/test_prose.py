"""The script that counts the prose of the pages, and the way to a first result."""

import subprocess
import sys
from pathlib import Path

import pytest

_SCRIPT = Path(__file__).parents[1] / ".ci/prose.py"
_DOORS = {
    "I have a SUMO scenario": "any_scenario",
    "I have a vehicle FMU": "vehicles",
    "I have a controller": "plugins",
    "I have a question for a paper": "studies",
}


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A folder with a README of four doors, and the pages that they link to."""
    (tmp_path / "docs").mkdir()
    doors = [f"**{door}.** It runs.\n\n```sh\nrun {page}\n```\n" for door, page in _DOORS.items()]
    readme = "\n".join(["# Name\n\nFor engineers.\n\n```sh\ninstall\n```\n", *doors])
    (tmp_path / "README.md").write_text(readme)
    for page in _DOORS.values():
        (tmp_path / f"docs/{page}.md").write_text("# Page\n\n## Section\n")
    return tmp_path


def _prose(root: Path, *options: str) -> tuple[int, list[str]]:
    command = [sys.executable, str(_SCRIPT), "--root", str(root), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert not done.stderr
    return done.returncode, done.stdout.splitlines()


_LONG = " ".join(["word"] * 26)


@pytest.mark.parametrize(
    ("text", "words", "mean"),
    [
        ("Two words. Then three words.", 5, 2.5),
        ("# A heading\n\nTwo words.\n\n```sh\nsome code\n```\n", 2, 2.0),
        ("<!-- a comment\nof two lines -->\nTwo words.", 2, 2.0),
        ("<!-- evidence: a -->\n*Commit.*\n\n| a |\n<!-- end -->\nTwo words.", 2, 2.0),
        ("[Two words](page.md) and `some inline code`.", 4, 4.0),
        ("![A picture](picture.png)\n\nTwo words.", 2, 2.0),
        ("* one\n* two words\n1. three words here", 6, 2.0),
        ("| a short | cell |\n|---|---|\n", 0, 0.0),
        (f"| {_LONG} | cell |\n|---|---|\n", 26, 26.0),
    ],
)
def test_words_of_sentences_and_of_long_cells_count(
    root: Path, text: str, words: int, mean: float
) -> None:
    (root / "docs/page.md").write_text(text)
    _, lines = _prose(root, "--pages")
    row = next(line.split() for line in lines if line.endswith("docs/page.md"))
    assert row == [str(words), str(mean), "0", "docs/page.md"]


def test_a_way_ends_at_its_first_result(root: Path) -> None:
    """README has 7 and 6 words on this way, and 20 typed characters; the page's are added."""
    before = float(_prose(root)[1][1].split()[0])
    words = " ".join(["word"] * 200)
    way = f"# Page\n\n{words}.\n\n```sh\n{'x' * 199}\n```\n\n## Section\n\n{words}.\n"
    (root / "docs/any_scenario.md").write_text(way)
    assert float(_prose(root)[1][1].split()[0]) == pytest.approx(before + 2.0)
    (root / "docs/any_scenario.md").write_text(
        way.replace("\n\n```", "\n\n<!-- first result -->```")
    )
    assert float(_prose(root)[1][1].split()[0]) == pytest.approx(before + 1.0)


@pytest.mark.parametrize(
    ("limits", "code"),
    [
        ((), 0),
        (("--words", "40", "--mean", "5", "--long", "0", "--minutes", "1"), 0),
        (("--words", "9"), 1),
        (("--mean", "1"), 1),
        (("--minutes", "0.1"), 1),
    ],
)
def test_only_a_limit_that_is_exceeded_fails(
    root: Path, limits: tuple[str, ...], code: int
) -> None:
    assert _prose(root, *limits)[0] == code


def test_sentences_of_more_than_forty_words_are_long(root: Path) -> None:
    (root / "docs/page.md").write_text(" ".join(["word"] * 41) + ".")
    assert _prose(root, "--long", "1")[0] == 1
