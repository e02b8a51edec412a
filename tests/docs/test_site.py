"""The documentation as a site: complete, without warnings, readable without a network."""

from __future__ import annotations

import importlib
import re
import runpy
import subprocess
import sys
import tomllib
from html.parser import HTMLParser
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlsplit

import pytest

import giveway

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")
NEEDED = ("sphinx", "myst_parser", "furo", "latex2mathml", "gymnasium")
BUILD = """
import gc, sys
gc.disable()  # a third of the time is spent on a search for garbage that is not there
from sphinx.cmd.build import main
sys.exit(main(sys.argv[1:]))
"""
FETCHED = {  # what a browser loads by itself
    ("script", "src"),
    ("img", "src"),
    ("iframe", "src"),
    ("source", "src"),
    ("object", "data"),
}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_reference_has_every_public_name(package: str) -> None:
    page = (ROOT / "docs" / "api" / f"{package}.md").read_text(encoding="utf-8")
    named = re.findall(r"^\.\. auto\w+:: (\w+)$", page, re.MULTILINE)
    public = set(importlib.import_module(package).__all__) - {"__version__"}
    assert sorted(named) == sorted(public)


def test_pages_link_to_the_repository_that_the_project_names_and_to_no_other() -> None:
    pytest.importorskip("latex2mathml")
    links = runpy.run_path(str(ROOT / "docs" / "conf.py"))["source_links"]
    address = "https://example.org/giveway"
    named = {"source_repository": address, "source_branch": "main"}
    assert links({"urls": {"Repository": address}}) == named
    assert links({"urls": {}}) == links({}) == {}


def menu() -> dict[str, dict[str, list[str]]]:
    """The pages of each part of the menu, by the entries above them."""
    parts = tomllib.loads((ROOT / "docs" / "menu.toml").read_text(encoding="utf-8"))
    page = re.compile(r"^.*<|>$")
    return {
        name: {
            page.sub("", entry): [page.sub("", one) for one in pages]
            for entry, pages in part.items()
        }
        for name, part in parts.items()
    }


def test_the_menu_has_four_parts_and_sixteen_entries_at_most() -> None:
    assert list(menu()) == ["Tutorials", "Guides", "Reference", "Evidence"]
    assert sum(map(len, menu().values())) <= 16


def test_every_page_is_in_the_menu_once() -> None:
    listed = [
        page for part in menu().values() for entry in part.items() for page in (entry[0], *entry[1])
    ]
    files = (file.relative_to(ROOT) for file in (ROOT / "docs").rglob("*.md"))
    pages = {file.with_suffix("").as_posix() for file in files} - {"docs/index"}
    assert sorted(pages - set(listed)) == []
    kinds = (".md", ".ipynb")
    there = [page for page in listed if any((ROOT / f"{page}{kind}").is_file() for kind in kinds)]
    assert listed == there
    assert len(listed) == len(set(listed))


class Page(HTMLParser):
    """What a page of the site refers to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []  # to be followed by a reader
        self.fetched: list[str] = []  # by the browser
        self.anchors: set[str] = set()
        self.equations = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attributes}
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        self.equations += tag == "math"
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        if tag == "link":
            self.fetched.append(values.get("href", ""))
        self.fetched += [values[name] for kind, name in FETCHED if kind == tag and name in values]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for module in NEEDED:
        pytest.importorskip(module, reason=f"{module}: giveway[docs] has it")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-c", BUILD, "-q", "-W", "--keep-going", "-c", "docs", ".", folder]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


def pages(site: Path) -> Iterator[tuple[Path, Page]]:
    for file in sorted(site.rglob("*.html")):
        yield file, Page(file.read_text(encoding="utf-8"))


def test_nothing_is_fetched_from_a_network(site: Path) -> None:
    remote = [
        (file.name, address)
        for file, page in pages(site)
        for address in page.fetched
        if urlsplit(address).scheme not in {"", "data"} or address.startswith("//")
    ]
    assert remote == []
    for sheet in site.rglob("*.css"):
        text = sheet.read_text(encoding="utf-8")
        assert not re.search(r"(@import|url\()\s*[\"']?\s*(https?:)?//", text), sheet


def test_links_between_pages_lead_somewhere(site: Path) -> None:
    there = dict(pages(site))
    broken = []
    for file, page in there.items():
        for address in page.links + page.fetched:
            parts = urlsplit(address)
            if parts.scheme or address.startswith("//"):
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if not target.is_file():
                broken.append((file.name, address))
            elif target in there and parts.fragment:
                broken += [(file.name, address)] * (
                    unquote(parts.fragment) not in there[target].anchors
                )
    assert broken == []


def test_pages_link_the_glossary_at_the_first_use_of_a_term(site: Path) -> None:
    text = (site / "docs" / "plugins.html").read_text(encoding="utf-8")
    assert text.count('href="glossary.html#term-safety-layer"') == 1
    people = (site / "docs" / "pedestrians.html").read_text(encoding="utf-8")
    assert "Gates et al." in people  # a name, no gate


def test_the_title_has_the_version(site: Path) -> None:
    text = (site / "docs" / "index.html").read_text(encoding="utf-8")
    assert f"<title>giveway {giveway.__version__}</title>" in text


def test_equations_are_written_into_the_pages(site: Path) -> None:
    text = (site / "docs" / "pedestrian_model.html").read_text(encoding="utf-8")
    assert Page(text).equations >= 2
    assert "<mfrac>" in text


def test_a_field_is_described_by_its_comment(site: Path) -> None:
    text = (site / "docs" / "api" / "controller.html").read_text(encoding="utf-8")
    assert "control step h [s]" in text
    assert "Alias for field number" not in text
