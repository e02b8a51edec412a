"""Shows notebooks as pages of the site: their cells become Markdown, which myst_parser reads."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from myst_parser.parsers.sphinx_ import MystParser

if TYPE_CHECKING:
    from docutils import nodes
    from sphinx.application import Sphinx

SUFFIX = ".ipynb"


def markdown_of(notebook: str) -> str:
    """Return the cells of a notebook (JSON) as Markdown; outputs are left out."""
    cells = json.loads(notebook)["cells"]
    return "\n\n".join(map(_markdown_of_cell, cells)) + "\n"


def _markdown_of_cell(cell: dict[str, Any]) -> str:
    text = "".join(cell["source"])
    if cell["cell_type"] == "markdown":
        return text
    is_python = not any(line.startswith(("%", "!")) for line in text.splitlines())
    return f"```{'python' if is_python else 'text'}\n{text}\n```"


class NotebookParser(MystParser):
    """The parser of notebooks."""

    supported = ("notebook",)

    def parse(self, inputstring: str, document: nodes.document) -> None:
        """Parse a notebook into a page."""
        super().parse(markdown_of(inputstring), document)


def setup(app: Sphinx) -> dict[str, bool]:
    """Let Sphinx read notebooks."""
    app.add_source_suffix(SUFFIX, "notebook")
    app.add_source_parser(NotebookParser)
    return {"parallel_read_safe": True}
