"""Link each term of docs/glossary.md where a page of the site first uses it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from docutils import nodes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

GLOSSARY = "docs/glossary"
TEXT = (Path(__file__).parent / "glossary.md").read_text(encoding="utf-8")
TERMS = sorted(set(re.findall(r"^\| (?!term )([^|`]+?) +\|", TEXT, re.M)), key=len, reverse=True)
USE = re.compile(rf"\b({'|'.join(map(re.escape, TERMS))})(?:e?s)?\b")
# Parts of a page that keep their words as they are.
KEPT = (nodes.reference, nodes.literal, nodes.title, nodes.entry, nodes.FixedTextElement)


def setup(app: Sphinx) -> dict[str, bool]:
    """Name the glossary's rows when it is read, and link them when the others are written."""
    app.connect("doctree-read", name_rows)
    app.connect("doctree-resolved", link_terms)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def anchor(term: str) -> str:
    """Return the id of a term's row."""
    return "term-" + nodes.make_id(term)


def name_rows(app: Sphinx, page: nodes.document) -> None:
    """Give each row of the glossary the id of its term."""
    bodies = page.findall(nodes.tbody) if app.env.docname == GLOSSARY else []
    for row in (row for body in bodies for row in body.children):
        row["ids"].append(anchor(row.children[0].astext()))


def link_terms(app: Sphinx, page: nodes.document, name: str) -> None:
    """Link the first use of each term in the running text of a page."""
    if not name.startswith("docs/") or name.startswith("docs/api/") or name == GLOSSARY:
        return
    glossary, linked = app.builder.get_relative_uri(name, GLOSSARY), set()
    parts = page.findall(lambda node: isinstance(node, KEPT))
    kept = {id(text) for part in parts for text in part.findall(nodes.Text)}
    for text in [text for text in page.findall(nodes.Text) if id(text) not in kept]:
        pieces, end = [], 0
        for use in USE.finditer(text):
            if (term := use[1]) not in linked:
                linked.add(term)
                link = nodes.reference("", use[0], internal=True, classes=["term"])
                link["refuri"] = f"{glossary}#{anchor(term)}"
                pieces += [nodes.Text(text[end : use.start()]), link]
                end = use.end()
        if pieces:
            text.parent.replace(text, [*pieces, nodes.Text(text[end:])])
