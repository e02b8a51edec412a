"""How Sphinx makes the site of the documentation: CONTRIBUTING.md has the command.

The repository is the source folder, so that the pages are the files that GitHub shows, with the
same links between them. Equations become MathML while the site is built: a page needs no network.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from latex2mathml.converter import convert

from giveway import __version__

if TYPE_CHECKING:
    from docutils import nodes
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

DOCS = Path(__file__).parent
MENU = tomllib.loads((DOCS / "menu.toml").read_text(encoding="utf-8"))
PROJECT = tomllib.loads((DOCS.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]

sys.path.insert(0, str(DOCS))  # field_comments, glossary_links, notebook_pages


def source_links(metadata: dict[str, Any]) -> dict[str, str]:
    """Options with which each page links to its source; none as long as no repository is named."""
    repository = metadata.get("urls", {}).get("Repository")
    return {"source_repository": repository, "source_branch": "main"} if repository else {}


project = "giveway"
author = "the giveway engineers"
project_copyright = "the giveway engineers, MIT licence"
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "field_comments",
    "glossary_links",
    "notebook_pages",
]
root_doc = "docs/index"
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "docs/*.md",
    "docs/**/*.md",
    "docs/notebooks/*.ipynb",
    "fmus/README.md",
    "sumo_scenarios/README.md",
]
exclude_patterns = [".*", ".venv/**", "build/**", "dist/**", "results/**"]

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_fence_as_directive = ["math"]  # as on GitHub
myst_heading_anchors = 4
myst_links_external_new_tab = False

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
napoleon_google_docstring = True
napoleon_use_ivar = True
add_module_names = False

html_theme = "furo"
html_title = f"giveway {version}"
html_theme_options = source_links(PROJECT)
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = [("site.js", {"defer": "defer"})]
html_additional_pages = {"index": "first_page.html"}
templates_path = ["_templates"]
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # a page that is opened as a file cannot read others
html_math_renderer = "mathml"


def inline_equation(writer: HTML5Translator, node: nodes.Element) -> None:
    """Write an equation within a line."""
    writer.body.append(convert(node.astext()))
    skip_children()


def block_equation(writer: HTML5Translator, node: nodes.Element) -> None:
    """Write an equation of its own, with its number if it has one."""
    writer.body.append(writer.starttag(node, "div", CLASS="math"))
    if node.get("number"):
        writer.body.append(f'<span class="eqno">({node["number"]})</span>')
    writer.body.append(convert(node.astext(), display="block") + "</div>\n")
    skip_children()


def skip_children() -> None:
    """Tell docutils that what is inside has been written."""
    from docutils import nodes

    raise nodes.SkipNode


def add_menu(app: Sphinx, name: str, source: list[str]) -> None:
    """Add the pages below this one, as docs/menu.toml lists them."""
    entries = {page_of(entry): pages for part in MENU.values() for entry, pages in part.items()}
    for caption, pages in (MENU if name == root_doc else {"": entries.get(name, [])}).items():
        listed = [page.replace(page_of(page), f"/{page_of(page)}") for page in pages]
        head = ["```{toctree}", ":hidden:", *([f":caption: {caption}"] if caption else [])]
        source[0] += "\n".join(["\n", *head, "", *listed, "```\n"]) if listed else ""


def page_of(entry: str) -> str:
    """Return the page that an entry of the menu names."""
    return entry.rpartition("<")[2].rstrip(">")


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the menu and the renderer of equations."""
    app.connect("source-read", add_menu)
    app.add_html_math_renderer("mathml", (inline_equation, None), (block_equation, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
