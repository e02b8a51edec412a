"""Digest of the code that a page's numbers depend on; comments and docstrings do not count."""

from __future__ import annotations

import ast
import functools
import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2]
DATA = (".toml", ".xml", ".sumocfg", ".c", ".h", ".fmu")
"""Suffixes of files that count byte by byte."""
PRINTED = (".md", ".ipynb")
"""Those of files in docs that do, too: they are run as they are printed."""


def digest_of(rooms: Iterable[str], settings: str) -> str:
    """Digest of all files of some rooms and of the settings with which they run.

    Args:
        rooms: Folders or files, relative to the repository.
        settings: Text that holds seeds, sample sizes and commands.
    """
    whole = hashlib.sha256(settings.encode())
    for room in sorted(rooms):
        whole.update(_room_digest(HOUSE / room).encode())
    return whole.hexdigest()[:16]


def file_digest(path: Path) -> str:
    """SHA-256 of a file, or of all files below a folder in the order of their paths."""
    whole = hashlib.sha256()
    for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
        if file.is_file():
            whole.update(file.read_bytes())
    return whole.hexdigest()


@functools.cache
def _room_digest(room: Path) -> str:
    if not room.exists():
        raise FileNotFoundError(
            f"{room}: no such room; expected a folder or file of the repository: name it in "
            "benchmarks/evidence/pages.py"
        )
    whole = hashlib.sha256()
    for path in sorted(room.rglob("*")) if room.is_dir() else [room]:
        if path.suffix == ".py":
            tree = ast.parse(path.read_bytes())
            content = "\n".join(_statements(tree)).encode()
        elif path.suffix in DATA or (path.suffix in PRINTED and HOUSE / "docs" in path.parents):
            content = path.read_bytes()
        else:
            continue
        whole.update(path.relative_to(HOUSE).as_posix().encode() + content)
    return whole.hexdigest()


def _statements(node: ast.AST) -> Iterator[str]:
    """Nodes and constants of a tree, the same in each version of Python."""
    yield type(node).__name__
    for name, value in ast.iter_fields(node):
        if name in {"kind", "type_comment", "type_params", "type_ignores"}:
            continue
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant):
                continue  # a docstring
            if isinstance(part, ast.AST):
                yield from _statements(part)
            elif part is not None:
                yield f"{name}={part!r}"
