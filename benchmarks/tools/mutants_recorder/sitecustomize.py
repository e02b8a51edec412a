"""Writes down which functions of a tree a process executes: ``mutants.py map`` loads it.

Python imports this module at the start of every process that has its folder on PYTHONPATH, so
children of tests are recorded as well. Each function of the tree gets one more statement in front,
when its module is imported; it appends the function's name to a file, at the first call only and
at once, so that nothing is lost with a killed process. The sources stay as they are.

``MUTANTS_RECORD`` names that file, ``MUTANTS_FUNCTIONS`` the folder in which ``functions.json``
says, per source file, in which line which function begins. Compiled modules are kept there too.
"""

from __future__ import annotations

import json
import marshal
import os
from contextlib import suppress
from importlib.machinery import SourceFileLoader
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import ast
    from types import CodeType

_HOOK = "__executed_in_a_recorded_tree__"
_seen: set[str] = set()


def _executed(name: str) -> None:
    if name not in _seen:
        _seen.add(name)
        with suppress(OSError), Path(os.environ["MUTANTS_RECORD"]).open("a") as record:
            record.write(name + "\n")


def _with_hooks(source: bytes, path: str, names: dict[str, str]) -> CodeType:
    import ast  # only where a module is compiled for the first time

    tree = ast.parse(source, path)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and str(node.lineno) in names:
            first = node.body[0]
            call = ast.parse(f"{_HOOK}({names[str(node.lineno)]!r})").body[0]
            for part in ast.walk(call):
                _move(part, first)
            node.body.insert(1 if ast.get_docstring(node, clean=False) is not None else 0, call)
    code: CodeType = compile(tree, path, "exec", dont_inherit=True)
    return code


def _move(part: ast.AST, to: ast.stmt) -> None:
    for place in ("lineno", "col_offset", "end_lineno", "end_col_offset"):
        if hasattr(part, place):
            setattr(part, place, getattr(to, place))


def _install(folder: Path) -> None:
    import builtins

    functions: dict[str, dict[str, str]] = json.loads((folder / "functions.json").read_text())
    usual = SourceFileLoader.get_code

    def get_code(loader: Any, module: str) -> CodeType | None:
        path = loader.get_filename(module)
        names = functions.get(path)
        if names is None:
            return usual(loader, module)
        kept = folder / f"{module}.marshal"
        with suppress(OSError, ValueError, EOFError):
            code: CodeType = marshal.loads(kept.read_bytes())
            return code
        code = _with_hooks(loader.get_data(path), path, names)
        with suppress(OSError):
            unfinished = folder / f"{module}.{os.getpid()}"
            unfinished.write_bytes(marshal.dumps(code))
            unfinished.replace(kept)
        return code

    setattr(builtins, _HOOK, _executed)
    setattr(SourceFileLoader, "get_code", get_code)  # noqa: B010 - a method of our own


if "MUTANTS_RECORD" in os.environ and "MUTANTS_FUNCTIONS" in os.environ:
    _install(Path(os.environ["MUTANTS_FUNCTIONS"]))
