"""Where the functions of a tree can be given one small fault each: found by syntax, edited as text.

A site is a stretch of a source file and what stands there instead; the rest of the file keeps its
bytes. There are none in docstrings, annotations, errors that are raised, f-strings, ``__repr__``,
defaults of arguments and blocks that only type checkers read.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

_SWAPS: Final = {
    "comparison": {
        "<": "<=",
        "<=": "<",
        ">": ">=",
        ">=": ">",
        "==": "!=",
        "!=": "==",
        "is": "is not",
        "is not": "is",
        "in": "not in",
        "not in": "in",
    },
    "arithmetic": {
        "+": "-",
        "-": "+",
        "*": "/",
        "/": "*",
        "//": "*",
        "%": "*",
        "**": "*",
        "+=": "-=",
        "-=": "+=",
        "*=": "/=",
        "/=": "*=",
        "//=": "*=",
        "%=": "*=",
    },
    "boolean": {"and": "or", "or": "and"},
    "extremum": {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum"},
}
_BETWEEN: Final = re.compile(rb"[\s)\\]*([^\s()\\#](?:[^()\\#]*[^\s()\\#])?)[\s(\\]*")
_MESSAGES: Final = {"msg", "message"}
_UNCHANGED: Final = {"__repr__", "__str__"}

AnyFunction = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Site:
    """A stretch of bytes of a file, and what a mutant has there instead.

    Attributes:
        operator: the kind of fault, and which one of that kind.
        line: the source line in which the stretch begins, without its margins.
        ordinal: which one of the same operator in the function's lines of the same text.
        start: of the stretch [bytes].
        end: of the stretch [bytes].
        text: what stands there instead.
    """

    operator: str
    line: str
    ordinal: int
    start: int
    end: int
    text: bytes

    def applied(self, source: bytes) -> bytes:
        """The source with the fault."""
        return source[: self.start] + self.text + source[self.end :]


def find_sites(function: AnyFunction, source: bytes) -> tuple[Site, ...]:
    """The sites of a function, but for those of functions that are defined in it.

    Args:
        function: a part of the syntax tree of ``source``.
        source: the whole file.
    """
    finder = _SiteFinder(source)
    if function.name not in _UNCHANGED:
        for statement in function.body:
            finder.visit(statement)
    return tuple(finder.sites())


def names_in(node: ast.AST) -> set[str]:
    """All names of variables and attributes that a part of the syntax tree mentions."""
    names = {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}
    return names | {part.attr for part in ast.walk(node) if isinstance(part, ast.Attribute)}


class _SiteFinder(ast.NodeVisitor):
    """Collects the sites of one function; those of functions in it are theirs."""

    def __init__(self, source: bytes) -> None:
        self._source = source
        self._lines = source.splitlines(keepends=True)
        self._starts = [0]
        for line in self._lines:
            self._starts.append(self._starts[-1] + len(line))
        self._found: list[tuple[str, int, int, bytes]] = []

    def sites(self) -> Iterator[Site]:
        count: Counter[tuple[str, str]] = Counter()
        for operator, start, end, text in sorted(self._found):
            number = next(i for i, s in enumerate(self._starts) if s > start) - 1
            line = " ".join(self._lines[number].decode().split())
            yield Site(operator, line, count[operator, line], start, end, text)
            count[operator, line] += 1

    def _span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        start = self._starts[node.lineno - 1] + node.col_offset
        return start, self._starts[node.end_lineno - 1] + node.end_col_offset

    def _add(self, operator: str, span: tuple[int, int], text: str | bytes) -> None:
        self._found.append((operator, *span, text.encode() if isinstance(text, str) else text))

    def _swap_between(self, kind: str, left: ast.expr, right: ast.expr) -> None:
        start, end = self._span(left)[1], self._span(right)[0]
        token = _BETWEEN.fullmatch(self._source, start, end)
        if token is not None:  # else a comment stands between the operands
            old = " ".join(token[1].decode().split())
            if old in _SWAPS[kind]:
                new = _SWAPS[kind][old]
                self._add(f"{kind} {old} to {new}", token.span(1), new)

    def visit_Compare(self, node: ast.Compare) -> None:
        for left, right in pairwise([node.left, *node.comparators]):
            self._swap_between("comparison", left, right)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if not (_is_text(node.left) or _is_text(node.right)):
            self._swap_between("arithmetic", node.left, node.right)
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if not _is_text(node.value):
            self._swap_between("arithmetic", node.target, node.value)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        for left, right in pairwise(node.values):
            self._swap_between("boolean", left, right)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        value, span = node.value, self._span(node)
        if isinstance(value, bool):
            self._add(f"constant {value} to {not value}", span, str(not value))
        elif isinstance(value, int | float):
            self._add("constant plus 1", span, repr(value + 1))
            if value:
                self._add("constant times 2", span, repr(value * 2))

    def visit_If(self, node: ast.If | ast.While | ast.IfExp) -> None:
        if "TYPE_CHECKING" not in names_in(node.test):
            start, end = self._span(node.test)
            self._add("condition negated", (start, end), b"not (%b)" % self._source[start:end])
            self.generic_visit(node)

    visit_While = visit_IfExp = visit_If  # noqa: N815

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is not None:
            if not (isinstance(node.value, ast.Constant) and node.value.value is None):
                self._add("return None", self._span(node.value), "None")
            self.generic_visit(node)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self._add("call removed", self._span(node), "pass")
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        function = node.func
        name = function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")
        if name in _SWAPS["extremum"]:
            end = self._span(function)[1]
            new = _SWAPS["extremum"][name]
            self._add(f"extremum {name} to {new}", (end - len(name), end), new)
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not any(isinstance(t, ast.Name) and t.id in _MESSAGES for t in node.targets):
            self.generic_visit(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_FunctionDef(self, node: ast.AST) -> None:
        """Nothing in it belongs to this function, or is code."""

    visit_AsyncFunctionDef = visit_ClassDef = visit_Raise = visit_JoinedStr = visit_FunctionDef  # noqa: N815


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
