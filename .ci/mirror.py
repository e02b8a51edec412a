"""Counts the modules that have a test file of their name at the mirrored place.

The module ``giveway/geometry/path.py`` is tested in ``tests/giveway/geometry/test_path.py``, and
``pedestrian_model/_check.py`` in ``tests/pedestrian_model/test_check.py``. Modules that only import
do not count, nor does a list ``__all__`` of what is imported.

    python .ci/mirror.py                # shares, room by room, and the modules without a file
    python .ci/mirror.py --least 60     # fails below 60 %
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("giveway", "controller", "pedestrian_model", "fmus", "sumo_scenarios")


def only_imports(statement: ast.stmt) -> bool:
    """Return whether a statement imports, or lists or explains what is imported."""
    match statement:
        case ast.Import() | ast.ImportFrom():
            return True
        case ast.Expr(value=ast.Constant(value=str())):
            return True
        case ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return True
        case ast.Assign(targets=[ast.Name(id="__all__")]):
            return True
    return False


def test_file_of(module: Path) -> Path:
    """Return the mirrored place of a module's tests.

    Args:
        module: Path of the module below the root.
    """
    name = "init" if module.name == "__init__.py" else module.stem.lstrip("_")
    return Path("tests") / module.parent / f"test_{name}.py"


def modules() -> list[Path]:
    """Return the modules with a statement that is no import, below the root."""
    files = [file for package in PACKAGES for file in sorted((ROOT / package).rglob("*.py"))]
    return [
        file.relative_to(ROOT)
        for file in files
        if not all(map(only_imports, ast.parse(file.read_text(encoding="utf-8")).body))
    ]


def main() -> int:
    """Print the shares; return 1 if the whole share is below ``--least``."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--least", type=float, default=0.0, metavar="PER_CENT")
    least = parser.parse_args().least
    everything = modules()
    missing = [module for module in everything if not (ROOT / test_file_of(module)).is_file()]
    rooms = Counter("/".join(module.parts[:-1][:2]) for module in everything)
    without = Counter("/".join(module.parts[:-1][:2]) for module in missing)
    for room, count in sorted(rooms.items()):
        print(f"{count - without[room]:4d} of {count:3d}  {room}")
    print("without:", " ".join(map(str, missing)))
    tested = len(everything) - len(missing)
    share = 100.0 * tested / len(everything)
    print(f"{tested} of {len(everything)} modules have a test file of their name: {share:.1f} %")
    return int(share < least)


if __name__ == "__main__":
    sys.exit(main())
