"""The README as a package index shows it: its links to files of the repository lead there.

An index shows the README alone, where relative links lead nowhere. With ``Repository`` among the
``[project.urls]`` of pyproject.toml they become links into the repository at the version's tag;
without one, as long as giveway has no public place, their words stay, and links and pictures go.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

_LINK = re.compile(r"(!?)\[([^\]]*)\]\((?!https?://|mailto:|#)([^)\s]+)\)")


class ReadmeHook(MetadataHookInterface):
    """Sets the project's long description."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Fill in ``readme``."""
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        repository = metadata.get("urls", {}).get("Repository", "")
        metadata["readme"] = {
            "content-type": "text/markdown",
            "text": for_an_index(text, repository.rstrip("/"), metadata["version"]),
        }


def for_an_index(text: str, repository: str, version: str) -> str:
    """A README without relative links.

    Args:
        text: the README.
        repository: its address; empty: it has none.
        version: of the package; its tag is ``v`` and this.
    """

    def turned(link: re.Match[str]) -> str:
        picture, words, target = link.groups()
        if not repository:
            return "" if picture else words
        kind = "raw" if picture else "blob"
        return f"{picture}[{words}]({repository}/{kind}/v{version}/{target})"

    return re.sub(r"\n{3,}", "\n\n", _LINK.sub(turned, text))
