"""Studies made of real runs: one small one, and what may become of it."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from functools import cache
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import pytest

from giveway.gate import MAKER, fingerprint, signed
from giveway.reports import report_page
from giveway.reports.examples import drives_of
from giveway.reports.report_page import write_report
from giveway.studies.definition import parse_definition
from giveway.studies.design import design
from giveway.studies.folder.sealing import SEAL, sealed
from giveway.studies.folder.store import RecordStore
from giveway.studies.folder.study_folder import StudyFolder
from giveway.studies.folder.table_files import write_tables
from giveway.studies.identity import software_identity
from giveway.studies.record import CRASHED
from giveway.studies.repeated_run import rerun

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from giveway.studies.record import RunRecord

SMALL = """
name = "small"
description = "MPC against PID, <script>alert('x')</script> & others"
replications = 9
reference = "yang2019"
run = { scenario = "shared_space" }

[factors]
"crowd.pedestrians" = [30, 10]
controller = ["mpc-paper", "pid-paper"]

[comparison]
baseline = "pid-paper"
resamples = 199
minimum_pairs = 4
"""


@pytest.fixture(scope="session")
def study(
    study_of: Callable[..., StudyFolder], tmp_path_factory: pytest.TempPathFactory
) -> StudyFolder:
    """Two densities, two controllers, nine crowds."""
    return study_of(SMALL, tmp_path_factory.mktemp("studies") / "small")


@pytest.fixture
def changed(study: StudyFolder, tmp_path: Path) -> Callable[..., StudyFolder]:
    """A copy of the study with some records replaced, or with another study file."""

    def change(
        edit: Callable[[RunRecord], RunRecord], toml: Callable[[str], str] = str
    ) -> StudyFolder:
        folder = tmp_path / "changed"
        shutil.copytree(study.path, folder)
        (folder / "report.html").unlink(missing_ok=True)
        software = software_identity()
        store = RecordStore(folder, software)
        for _, _, record in study.records:
            store.put(edit(record))
        path = folder / "study.toml"
        path.write_text(toml(path.read_text("utf-8")), encoding="utf-8")
        cells = design(parse_definition(path.read_text("utf-8"), "study.toml", folder), "").cells
        manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
        for entry, cell in zip(manifest["cells"], cells, strict=True):
            entry["label"] = cell.label
        manifest["definition"] = fingerprint(path.read_bytes())
        del manifest[SEAL], manifest[MAKER]
        text = json.dumps(signed(sealed(manifest, software)))
        (folder / "manifest.json").write_text(text, encoding="utf-8")
        for name in ("comparison", "situations"):
            (folder / f"{name}.csv").unlink()
        found = StudyFolder.open(folder)
        write_tables(found, whole=True)
        return StudyFolder.open(folder)

    return change


@pytest.fixture
def lost(changed: Callable[..., StudyFolder]) -> StudyFolder:
    """The study with one run that crashed."""

    def crash(record: RunRecord) -> RunRecord:
        if record.run != "c1-s3":
            return record
        return replace(record, ending=CRASHED, rows=(), failure="SIGKILL <b>at</b> 4.2 s")

    return changed(crash)


@pytest.fixture(scope="session")
def again(study: StudyFolder) -> Callable[[str], Any]:
    """The drives of a run that is made again, each only once."""
    return cache(lambda run: drives_of(rerun(study, run)))


@pytest.fixture(scope="session")
def report(study: StudyFolder, again: Callable[[str], Any]) -> Path:
    """The report of the study; nobody changes it."""

    def replay(run: str) -> Path:
        page = study.path / "replays" / f"{run}.html"
        page.parent.mkdir(exist_ok=True)
        page.write_text("a replay")
        return page

    return write_report(study, drives=again, replay=replay)


@pytest.fixture
def unpictured(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports without the study's figures, for tests of what stands beside them."""
    monkeypatch.setattr(report_page, "study_pictures", lambda _: ())


class Page(HTMLParser):
    """A page taken apart: tags, ids, links, tables, text."""

    VOID = frozenset({"meta", "link", "br", "img", "input", "hr"})

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.tables: dict[str, list[list[str]]] = {}
        self.captions: dict[str, str] = {}
        self.open: list[str] = []
        self.words: list[str] = []
        self._table = ""
        self._cell: list[str] | None = None
        self.feed(html)
        self.close()

    @property
    def ids(self) -> list[str]:
        return [values["id"] for _, values in self.tags if "id" in values]

    @property
    def links(self) -> list[str]:
        return [values["href"] for tag, values in self.tags if tag == "a"]

    @property
    def text(self) -> str:
        return " ".join("".join(self.words).split())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.tags.append((tag, values))
        if tag not in self.VOID:
            self.open.append(tag)
        if tag == "table":
            self._table = values["id"]
            self.tables[self._table] = []
        if tag == "tr":
            self.tables[self._table].append([])
        if tag in {"td", "th", "caption"}:
            self._cell = []

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, f"</{tag}> closes another element"
        if tag in {"td", "th", "caption"} and self._cell is not None:
            text = "".join(self._cell).strip()
            if tag == "caption":
                self.captions[self._table] = text
            else:
                self.tables[self._table][-1].append(text)
            self._cell = None

    def handle_data(self, data: str) -> None:
        if "script" not in self.open and "style" not in self.open:
            self.words.append(data)
        if self._cell is not None:
            self._cell.append(data)


@pytest.fixture(scope="session")
def parsed() -> Callable[[Path], Page]:
    return lambda path: Page(path.read_text(encoding="utf-8"))
