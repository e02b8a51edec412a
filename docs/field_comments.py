"""Sphinx extension: the comment behind a field is the field's description.

giveway's records say unit and meaning behind each field, ``mass: float  # [kg]``, which autodoc
does not read. A comment may go on in lines of its own below.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import textwrap
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

ALIAS = "Alias for field number"  # what Python says of a named tuple's field


@cache
def comments(cls: type) -> dict[str, str]:
    """The comment of each field of a class, its bases' fields included."""
    found: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        try:
            source = textwrap.dedent(inspect.getsource(base))
        except (OSError, TypeError):
            continue
        found |= comments_in(source)
    return found


def comments_in(source: str) -> dict[str, str]:
    """The comment behind each annotated name in the source of a class."""
    lines = source.splitlines()
    found = {}
    for node in ast.parse(source).body[0].body:  # type: ignore[attr-defined]
        if not isinstance(node, ast.AnnAssign) or not isinstance(node.target, ast.Name):
            continue
        end = node.end_lineno or node.lineno
        behind = lines[end - 1].encode()[node.end_col_offset :].decode().strip()
        if not behind.startswith("#"):
            continue
        parts = [behind]
        for line in lines[end:]:  # deeper than a field, and nothing but a comment
            if not line.startswith("     ") or not line.strip().startswith("#"):
                break
            parts.append(line.strip())
        found[node.target.id] = " ".join(part.lstrip("# ") for part in parts)
    return found


def class_of(name: str) -> type | None:
    """The class that a dotted name of one of its fields belongs to."""
    module, _, path = name.partition(".")
    here: Any = importlib.import_module(module)
    for part in path.split(".")[:-1]:
        here = getattr(here, part, None)
    return here if isinstance(here, type) else None


def describe(
    app: Sphinx, what: str, name: str, member: object, options: object, lines: list[str]
) -> None:
    """Let a field's comment be its text, where it has no other."""
    if what != "attribute" or not (not lines or lines[0].startswith(ALIAS)):
        return
    cls = class_of(name)
    text = comments(cls).get(name.rpartition(".")[2], "") if cls else ""
    lines[:] = [text.replace("*", "\\*").replace("_", "\\_"), ""] if text else []


def select(
    app: Sphinx, what: str, name: str, member: object, skip: bool, options: object
) -> bool | None:
    """Show fields that have a comment, though they have no docstring."""
    now = app.env.temp_data  # what autodoc is at
    module, current = now.get("autodoc:module"), now.get("autodoc:class")
    cls = class_of(f"{module}.{current}.{name}") if what == "class" and module and current else None
    return False if cls and skip and name in comments(cls) else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Join in where autodoc reads docstrings."""
    app.connect("autodoc-process-docstring", describe)
    app.connect("autodoc-skip-member", select)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
