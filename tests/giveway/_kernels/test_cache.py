"""Where compiled kernels are kept: the same place for the same kernels, and for no others."""

import os
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType

import pytest
from numba.core.dispatcher import Dispatcher

from giveway._cache_folder import remark
from giveway._kernels import cache as kernels_cache
from giveway._kernels.cache import KernelLocator, kernel_cache, kernel_digest
from giveway.geometry import passage
from giveway.geometry.kernel import kernel
from pedestrian_model.vci.constants import _exp

HOUSE = Path(kernels_cache.__file__).resolve().parents[2]
LOCATORS = "numba.config.CACHE_LOCATOR_CLASSES.count('giveway._kernels.cache.KernelLocator')"
INNER = re.compile(r"^@(?:inner|inlined)\ndef (\w+)", re.MULTILINE)
FOLDER = "giveway.geometry.path.project._cache.cache_path"


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """Our packages, installed at another place; the digest is taken there."""
    for room in ("controller", "pedestrian_model", "giveway"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(HOUSE / room, tmp_path / room, ignore=ignored)
    monkeypatch.setattr(kernels_cache, "_HOUSE", tmp_path)
    kernel_digest.cache_clear()
    yield tmp_path
    kernel_digest.cache_clear()


def test_the_same_kernels_at_another_place_are_the_same(elsewhere):
    there = KernelLocator.from_function(
        passage.window.py_func, str(elsewhere / "giveway/geometry/passage.py")
    )
    assert there is not None
    assert there.get_cache_path() == str(kernel_cache())
    assert there.get_cache_path() == passage.window._cache.cache_path
    assert there.get_source_stamp() == passage.window._cache._impl.locator.get_source_stamp()


@pytest.mark.parametrize(
    ("file", "matters"),
    [
        ("giveway/geometry/passage.py", True),  # inlined into kernels of other files
        ("giveway/geometry/kernel.py", True),  # how all are compiled
        ("controller/parameters.py", True),
        ("pedestrian_model/vci/constants.py", True),
        ("giveway/cli/commands/run_command.py", False),
    ],
)
def test_only_what_is_compiled_makes_another_folder(elsewhere, file, matters):
    before = kernel_digest()
    path = elsewhere / file
    path.write_text(path.read_text(encoding="utf-8") + "# changed\n", encoding="utf-8")
    kernel_digest.cache_clear()
    assert (kernel_digest() != before) == matters


def test_a_file_of_inlined_functions_alone_is_looked_at(elsewhere):
    before = kernel_digest()
    (elsewhere / "giveway/geometry/tiny.py").write_text("@inlined\ndef f(x):\n    return x\n")
    kernel_digest.cache_clear()
    assert kernel_digest() != before


HALF = """
from pedestrian_model.vci.constants import _exp
value = _exp(-1.0)
made_ready = 'numba.cpython.setobj' in sys.modules
print(f'{value:.6f}', sum(_exp.stats.cache_hits.values()), made_ready)
"""


def test_damaged_code_is_compiled_anew_after_one_note(capsys, monkeypatch, tmp_path):
    """Numba would end in a traceback, now and each time after it."""

    def value_and_hits():
        exponential = kernel(_exp.py_func)
        return round(exponential(-1.0), 6), len(exponential.stats.cache_hits)

    remark.cache_clear()
    monkeypatch.setattr(kernels_cache, "kernel_cache", lambda: tmp_path)
    assert value_and_hits() == (0.367879, 0)
    assert value_and_hits() == (0.367879, 1)
    (file,) = tmp_path.iterdir()
    code = file.read_bytes()
    file.write_bytes(code[: len(code) // 2])
    assert value_and_hits() == (0.367879, 0)
    assert capsys.readouterr().err.count("compiled code is damaged") == 1
    assert value_and_hits() == (0.367879, 1)


def test_a_changed_callee_is_seen_and_a_hit_needs_no_compiler(elsewhere, tmp_path):
    def exponential():
        script = f"sys.path.insert(0, {str(elsewhere)!r}); import giveway; exec({HALF!r})"
        return said(script, tmp_path, PYTHONPATH=str(elsewhere), **kept)

    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kernels"), "PYTHONDONTWRITEBYTECODE": "1"}
    for room in ("fmus", "sumo_scenarios"):
        shutil.copytree(HOUSE / room, elsewhere / room)
    assert exponential() == "0.367879 0 True"
    assert exponential() == "0.367879 1 False"
    callee = elsewhere / "pedestrian_model" / "_mathematics.py"
    text = callee.read_text(encoding="utf-8")
    changed = text.replace("return p * from_bits(", "return 2.0 * p * from_bits(")
    assert changed != text
    callee.write_text(changed, encoding="utf-8")
    assert exponential() == "0.735759 0 True"


def test_somebody_elses_function_is_numbas_own_business():
    assert KernelLocator.from_function(shutil.copy, shutil.__file__) is None
    assert KernelLocator.from_function(test_the_users_own_choice_wins, __file__) is None


def test_no_kernel_depends_on_a_file_that_is_not_looked_at():
    """Constants and types that a kernel takes from elsewhere are compiled into it."""
    for path in sorted((HOUSE / "giveway").rglob("*.py")):
        if kernels_cache._KERNEL.search(path.read_bytes()):
            module = import_module(".".join(path.relative_to(HOUSE).with_suffix("").parts))
            kernels = [k.py_func for k in vars(module).values() if isinstance(k, Dispatcher)]
            inner = [getattr(module, name) for name in INNER.findall(path.read_text("utf-8"))]
            assert kernels or inner or path.name == "kernel.py"
            for function in (*kernels, *inner):
                _check_origin(module, function)
        else:
            assert not re.search(rb"\bn?jit\(", path.read_bytes()), path


def _check_origin(module: ModuleType, function: FunctionType) -> None:
    if function.__module__ != module.__name__:
        return  # imported; it is looked at in its own module
    source = Path(module.__file__ or "").read_text(encoding="utf-8")
    for name in function.__code__.co_names:
        if isinstance(function.__globals__.get(name), ModuleType | Dispatcher | None):
            continue
        imported = re.search(rf"^from (\S+) import (?:\([^)]*|.*)\b{name}\b", source, re.MULTILINE)
        origin = imported[1] if imported else ""
        if origin.startswith("giveway."):
            file = Path(import_module(origin).__file__ or "")
            assert kernels_cache._KERNEL.search(file.read_bytes()), (module, name, origin)


def said(script: str, home: Path, **more: str) -> str:
    ours = {"NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "GIVEWAY_CACHE"}
    kept = {k: v for k, v in os.environ.items() if k not in ours}
    done = subprocess.run(
        [sys.executable, "-c", f"import os, sys; {script}"],
        env={**kept, "HOME": str(home), **more},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_importing_giveway_imports_no_numba_nor_changes_environ(tmp_path):
    script = (
        "before = dict(os.environ); import giveway; "
        "print('numba' in sys.modules, dict(os.environ) == before)"
    )
    assert said(script, tmp_path) == "False True"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the cache is not below HOME")
@pytest.mark.parametrize("order", ["import giveway, numba", "import numba, giveway"])
def test_whoever_imports_numba_first_the_users_cache_is_taken(order, tmp_path):
    script = f"{order}; import giveway.geometry.path; print({LOCATORS}, {FOLDER})"
    count, folder = said(script, tmp_path).split()
    assert count == "1"
    assert folder.startswith(str(tmp_path / ".cache" / "giveway" / "kernels-"))


def test_the_users_own_choice_wins(tmp_path):
    chosen = tmp_path / "mine"
    script = f"import giveway.geometry.path; print({FOLDER})"
    folder = Path(said(script, tmp_path, NUMBA_CACHE_DIR=str(chosen)))
    assert folder.parent == chosen
