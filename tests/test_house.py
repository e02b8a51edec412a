"""The house keeps its walls: who touches libsumo, what lies at the root, what a folder is for."""

from __future__ import annotations

import ast
import importlib.util
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")
LIBRARIES = {"libsumo", "_libsumo", "traci"}
IN_TEXT = re.compile(r"""(?:\bimport\s+|\bfrom\s+|import_module\(\s*["'])(?:libsumo|traci)\b""")
AT_THE_ROOT = 8  # modules, besides __init__ and __main__


def folder_of(package: str) -> Path:
    spec = importlib.util.find_spec(package)
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).parent


SOURCES = {
    f"{package}/{file.relative_to(folder_of(package)).as_posix()}": file
    for package in PACKAGES
    for file in sorted(folder_of(package).rglob("*.py"))
}


def imported(node: ast.AST) -> set[str]:
    """The packages that a statement imports."""
    if isinstance(node, ast.Import):
        return {alias.name.partition(".")[0] for alias in node.names}
    if isinstance(node, ast.ImportFrom) and not node.level:
        return {(node.module or "").partition(".")[0]}
    return set()


def imported_by_name(node: ast.AST) -> set[str]:
    """What a call like ``import_module("libsumo")`` imports."""
    if not isinstance(node, ast.Call) or not node.args:
        return set()
    called = ast.unparse(node.func).rpartition(".")[2]
    first = node.args[0]
    if called not in {"import_module", "__import__", "find_spec"}:
        return set()
    if not isinstance(first, ast.Constant) or not isinstance(first.value, str):
        return set()
    return {first.value.partition(".")[0]}


def touches(source: str) -> Iterator[str]:
    """Where a file imports SUMO's library, or reaches for its module through somebody else."""
    tree = ast.parse(source)
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    # A call of import_libsumo whose result nobody takes only makes sure that SUMO is there.
    only_tried = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        line = f"line {getattr(node, 'lineno', 0)}: "
        if found := (imported(node) | imported_by_name(node)) & LIBRARIES:
            yield f"{line}imports {', '.join(found)}"
        if isinstance(node, ast.Attribute) and (
            node.attr in LIBRARIES
            or (node.attr == "module" and re.search(r"(sumo|session)$", ast.unparse(node.value)))
        ):
            yield f"{line}takes the module: {ast.unparse(node)}"
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            if id(node) not in docstrings and IN_TEXT.search(node.value):
                yield f"{line}imports by a text: {node.value!r}"
            if node.value == "_libsumo":
                yield f"{line}takes the module by its name"
        if (
            isinstance(node, ast.Call)
            and ast.unparse(node.func).endswith("import_libsumo")
            and id(node) not in only_tried
        ):
            yield f"{line}takes what import_libsumo returns"


@pytest.mark.parametrize(
    "source",
    [
        "import libsumo",
        "import libsumo.simulation",
        "from libsumo import person",
        "def f():\n    import traci as t",
        'importlib.import_module("libsumo")',
        '__import__("libsumo")',
        "direct = sumo.libsumo",
        'direct = getattr(module, "_libsumo")',
        "part(self.sumo.module)",
        "part(session.module)",
        'run([python, "-c", "import libsumo; print(1)"])',
        "sumo = import_libsumo()",
    ],
)
def test_each_way_to_the_library_is_seen(source: str) -> None:
    assert list(touches(source))


@pytest.mark.parametrize(
    "source",
    [
        '"""Does not import libsumo."""',
        'PACKAGES = ("libsumo", "numba")',
        "import_libsumo()",
        "from giveway.sumo import SumoSession",
        "module.module",
    ],
)
def test_what_only_names_the_library_is_allowed(source: str) -> None:
    assert list(touches(source)) == []


def naming() -> dict[str, str]:
    """The texts of all files that could touch the library; the others need not be parsed."""
    texts = {name: file.read_text(encoding="utf-8") for name, file in SOURCES.items()}
    words = ("libsumo", "traci", ".module")
    return {name: text for name, text in texts.items() if any(word in text for word in words)}


def test_only_giveway_sumo_touches_libsumo() -> None:
    found = {
        name: list(touches(text))
        for name, text in naming().items()
        if not name.startswith("giveway/sumo/")
    }
    assert {name: places for name, places in found.items() if places} == {}


def test_one_file_imports_libsumo() -> None:
    importing = [
        name
        for name, text in naming().items()
        for node in ast.walk(ast.parse(text))
        if (imported(node) | imported_by_name(node)) & LIBRARIES
    ]
    assert len(set(importing)) == 1
    assert importing[0].startswith("giveway/sumo/")


def test_the_root_of_giveway_holds_the_door_and_little_else() -> None:
    door = {"__init__.py", "__main__.py"}
    root = {file.name for file in folder_of("giveway").glob("*.py")} - door
    assert len(root) <= AT_THE_ROOT, sorted(root)


@pytest.mark.parametrize("package", PACKAGES)
def test_every_folder_of_code_says_what_it_is_for(package: str) -> None:
    inits = {name for name in SOURCES if name.startswith(f"{package}/")}
    folders = {name.rpartition("/")[0] for name in inits}
    for folder in sorted(folders):
        init = SOURCES.get(f"{folder}/__init__.py")
        assert init is not None, f"{folder} has no __init__.py"
        purpose = ast.get_docstring(ast.parse(init.read_text(encoding="utf-8")))
        assert purpose, f"{folder}/__init__.py has no docstring"
        sentence = purpose.partition("\n\n")[0]
        assert sentence.endswith((".", ":", "?")), f"{folder}/__init__.py: {sentence!r}"


@pytest.mark.parametrize("package", PACKAGES)
def test_tests_lie_in_folders_of_the_names_of_the_products(package: str) -> None:
    here = Path(__file__).parent / package
    folders = {file.parent.relative_to(here) for file in here.rglob("test_*.py")}
    assert folders
    strange = [str(folder) for folder in folders if not (folder_of(package) / folder).is_dir()]
    assert strange == []
