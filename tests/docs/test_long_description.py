"""What a package index shows of the README works there."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("hatchling", reason="hatchling: giveway[dev] has it")

from hatchling.metadata.core import ProjectMetadata
from hatchling.plugin.manager import PluginManager

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def hook() -> Any:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def relative(text: str) -> list[str]:
    return [target for target in LINK.findall(text) if not re.match(r"https?:|#", target)]


def test_the_package_describes_itself_without_relative_links() -> None:
    core = ProjectMetadata(str(ROOT), PluginManager()).core
    assert core.readme_content_type == "text/markdown"
    assert core.readme.startswith("# giveway")
    assert not relative(core.readme)
    assert "CITATION.cff" in core.readme  # the words stay


@pytest.mark.parametrize("repository", ["https://example.org/us/giveway", ""])
def test_with_an_address_they_lead_into_the_repository(repository: str) -> None:
    assert len(relative(README)) > 20
    text = hook().for_an_index(README, repository, "1.2.3")
    assert not relative(text)
    into = [target for target in LINK.findall(text) if "example.org" in target]
    assert len(into) == (len(relative(README)) if repository else 0)
    if repository:
        assert f"{repository}/blob/v1.2.3/docs/controllers.md" in into
        assert f"{repository}/raw/v1.2.3/docs/figures/film.gif" in into
        for target in into:
            path = re.sub(r"^.*/v1\.2\.3/|#.*$", "", target)
            assert (ROOT / path).exists(), path
