"""Packages of other people, installed into a folder of their own without a network."""

from __future__ import annotations

import importlib
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


DOCS = Path(__file__).parents[2] / "docs"
PAGES = [(DOCS / name).read_text("utf-8") for name in ("plugins.md", "own_pedestrians.md")]


def printed(mark: str) -> str:
    """The block of docs/plugins.md or docs/own_pedestrians.md below a mark."""
    block = rf"<!-- {re.escape(mark)} -->\n```\w*\n(.*?)```"
    found = re.search(block, "".join(PAGES), re.DOTALL)
    assert found, mark
    return found.group(1)


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Path]]:
    """Install a module as pip would: (module, its text, version=, declares=, group=) -> its file.

    It can be imported here and in processes that are started from here.
    """
    site = tmp_path / "site"
    site.mkdir()
    monkeypatch.syspath_prepend(str(site))
    paths = [str(site), os.environ.get("PYTHONPATH", "")]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in paths if path))
    modules: list[str] = []

    def install(
        module: str,
        text: str,
        *,
        version: str = "1.0",
        declares: str = "",
        group: str = "giveway.controllers",
    ) -> Path:
        file = site / f"{module}.py"
        file.write_text(text, encoding="utf-8")
        for old in site.glob(f"{module}-*"):
            for part in old.iterdir():
                part.unlink()
            old.rmdir()
        info = site / f"{module}-{version}.dist-info"
        info.mkdir()
        about = f"Metadata-Version: 2.1\nName: {module.replace('_', '-')}\nVersion: {version}\n"
        (info / "METADATA").write_text(about, encoding="utf-8")
        (info / "RECORD").write_text(f"{module}.py,,\n{info.name}/METADATA,,\n", encoding="utf-8")
        if declares:
            points = f"[{group}]\n{declares}\n"
            (info / "entry_points.txt").write_text(points, encoding="utf-8")
        modules.append(module)
        sys.modules.pop(module, None)
        importlib.invalidate_caches()
        return file

    yield install
    for module in modules:
        sys.modules.pop(module, None)
