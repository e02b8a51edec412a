"""Every picture of README and docs stands beside a record of how it was made."""

from __future__ import annotations

import hashlib
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
FIGURES = ROOT / "docs" / "figures"
RECORDS: dict[str, dict[str, Any]] = tomllib.loads(
    (FIGURES / "records.toml").read_text(encoding="utf-8")
)
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def shown() -> dict[str, Path]:
    """The pictures that pages show, with a page of each."""
    return {
        str((page.parent / address).resolve().relative_to(ROOT)): page
        for page in PAGES
        for address in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
    }


def picture(name: str) -> Path:
    """The picture of a record."""
    return FIGURES / f"{name}{Path(RECORDS[name]['made']).suffix}"


def test_pages_and_folder_and_records_have_the_same_pictures() -> None:
    recorded = sorted(f"docs/figures/{picture(name).name}" for name in RECORDS)
    assert sorted(shown()) == recorded
    there = [file.name for file in FIGURES.iterdir() if file.suffix in {".png", ".gif"}]
    assert sorted(f"docs/figures/{name}" for name in there) == recorded


@pytest.mark.parametrize("name", RECORDS)
def test_the_picture_is_the_recorded_one(name: str) -> None:
    file = picture(name)
    assert hashlib.sha256(file.read_bytes()).hexdigest() == RECORDS[name]["sha256"], (
        f"{file.name} differs from its record: python docs/make_figures.py {name}"
    )


@pytest.mark.parametrize("name", RECORDS)
def test_a_record_says_how_to_make_it_again(name: str) -> None:
    record = RECORDS[name]
    assert record["commands"]
    assert re.fullmatch(r"[0-9a-f]{7,10}", record["commit"])
    assert picture(name).suffix in {".png", ".gif"}
    for file, told in record["data"].items():
        assert re.fullmatch(r"[0-9a-f]{64}", told), file


TABLES = tomllib.loads((ROOT / "docs" / "tables.toml").read_text(encoding="utf-8"))


def test_every_table_between_marks_has_a_record() -> None:
    marked = {
        (page.name, name)
        for page in (ROOT / "docs").glob("*.md")
        for name in re.findall(r"<!-- end of (.+?) -->", page.read_text(encoding="utf-8"))
    }
    recorded = [(page, record["table"]) for page, records in TABLES.items() for record in records]
    assert sorted(recorded) == sorted(marked)


@pytest.mark.parametrize("page", TABLES)
def test_a_table_on_a_page_is_written_by_an_existing_program(page: str) -> None:
    for record in TABLES[page]:
        *studies, last = record["commands"]
        script = ROOT / last.split()[1]
        assert script.is_file()
        assert last.startswith("python benchmarks/")
        assert "--write" in last
        assert f"docs/{page}" in script.read_text(encoding="utf-8")
        assert all(study.startswith("giveway study ") for study in studies)
        assert ("seeds" in record) == bool(studies)
