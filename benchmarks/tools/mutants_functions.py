"""The functions of a tree's five packages, and which of them a recorder sees.

Functions that numba compiles never run as Python. They count as executed where a Python function
that mentions their name is executed.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from mutants_sites import AnyFunction, Site, find_sites, names_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

PACKAGES: Final = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")

_COMPILERS: Final = {"kernel", "inlined", "njit", "jit", "intrinsic"}


@dataclass(frozen=True)
class Function:
    """A function or method of a tree, or a name that a module gives to others of its names.

    Attributes:
        package: the import package.
        file: its path in the tree.
        name: with the names of the classes and functions round it, joined by dots.
        line: in which ``def`` stands; 0 for a name that is no function's.
        compiled: by numba: Python never executes it, so that no recorder sees it.
        uses: names that its body mentions, as they are called where they are defined.
        sites: where it can be given a fault.
    """

    package: str
    file: str
    name: str
    line: int
    compiled: bool
    uses: frozenset[str]
    sites: tuple[Site, ...] = field(repr=False)

    @property
    def key(self) -> str:
        """What the recorder calls it."""
        return f"{self.file}:{self.name}"


def functions_of(tree: Path) -> list[Function]:
    """All functions of the five packages, in the order of their files and lines.

    Left out are files that build machine code (they import llvmlite): what they do happens when
    kernels are compiled, and not when tests run.
    """
    found: list[Function] = []
    for package in PACKAGES:
        for path in sorted((tree / package).rglob("*.py")):
            source = path.read_bytes()
            if b"from llvmlite" not in source:
                found += _File(package, path.relative_to(tree).as_posix(), source).functions()
    return found


def executors(function: Function, functions: Sequence[Function]) -> set[str]:
    """Keys of the functions whose execution a recorder sees when ``function`` is executed.

    The function's own; of a compiled one those of the Python functions that mention its name, or
    that of a compiled one which mentions it, and so on.
    """
    if not function.compiled:
        return {function.key}
    names, waiting = {function.name}, [function.name]
    keys: set[str] = set()
    while waiting:
        name = waiting.pop().rpartition(".")[2]
        for other in functions:
            if name not in other.uses:
                continue
            if not other.compiled:
                keys.add(other.key)
            elif other.name not in names:
                names.add(other.name)
                waiting.append(other.name)
    return keys


def compiled_with(function: Function, functions: Sequence[Function]) -> list[Function]:
    """The compiled functions whose machine code may contain that of ``function``; itself too."""
    found = [function]
    for inner in found:
        name = inner.name.rpartition(".")[2]
        found += [o for o in functions if o.compiled and name in o.uses and o not in found]
    return found


class _File:
    """A source file's functions."""

    def __init__(self, package: str, file: str, source: bytes) -> None:
        self._package, self._file, self._source = package, file, source
        self._module = ast.parse(source)
        self._aliases = {
            alias.asname: alias.name.rpartition(".")[2]
            for node in ast.walk(self._module)
            if isinstance(node, ast.Import | ast.ImportFrom)
            for alias in node.names
            if alias.asname is not None
        }
        self._passed_to_compilers = {
            argument.id
            for node in ast.walk(self._module)
            if isinstance(node, ast.Call) and _COMPILERS & names_in(node.func)
            for argument in node.args
            if isinstance(argument, ast.Name)
        }

    def functions(self) -> list[Function]:
        return [*self._defined(self._module.body, ""), *self._assigned()]

    def _defined(self, body: Sequence[ast.AST], prefix: str) -> Iterator[Function]:
        for node in body:
            if isinstance(node, ast.ClassDef):
                yield from self._defined(node.body, f"{prefix}{node.name}.")
            elif isinstance(node, AnyFunction):
                function = self._function(node, prefix + node.name)
                yield function
                if not function.compiled:
                    yield from self._defined(node.body, f"{function.name}.")
            elif not (isinstance(node, ast.If) and "TYPE_CHECKING" in names_in(node.test)):
                yield from self._defined(list(ast.iter_child_nodes(node)), prefix)

    def _function(self, node: AnyFunction, name: str) -> Function:
        decorators = {n for decorator in node.decorator_list for n in names_in(decorator)}
        compiled = bool(decorators & _COMPILERS) or node.name in self._passed_to_compilers
        return Function(
            self._package,
            self._file,
            name,
            node.lineno,
            compiled,
            self._uses(node.body),
            find_sites(node, self._source),
        )

    def _assigned(self) -> Iterator[Function]:
        """A module's constants pass on the names they are made of, like compiled functions."""
        for node in self._module.body:
            if isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                uses = self._uses([node.value])
                for target in targets:
                    if isinstance(target, ast.Name) and uses:
                        yield Function(self._package, self._file, target.id, 0, True, uses, ())

    def _uses(self, nodes: Sequence[ast.AST]) -> frozenset[str]:
        return frozenset(self._aliases.get(n, n) for node in nodes for n in names_in(node))
