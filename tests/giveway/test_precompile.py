"""The compilation after installation is complete: no run waits for the compiler again."""

import os
import subprocess
import sys
import time
from pathlib import Path

from giveway.precompile import forget_old_kernels

SCRIPT = """
import io, sys
from numba.core.dispatcher import Dispatcher
from rich.console import Console
import giveway
from giveway.kernels import compile_kernels_once

def compiled():
    rooms = {"giveway", "controller", "pedestrian_model"}
    return {
        (name, key): sum(value.stats.cache_misses.values())
        for name, module in list(sys.modules.items()) if name.split(".")[0] in rooms
        for key, value in vars(module).items() if isinstance(value, Dispatcher)
    }

screen = io.StringIO()
compile_kernels_once(Console(file=screen))
before = compiled()
for settings in ({"seed": 4}, {"seed": 3, "controller": "pid"}, {"scenario": "street"}):
    giveway.run(settings).summary
late = {key for key, count in compiled().items() if count > before.get(key, 0)}
assert not late, late
print(screen.getvalue())
"""


def test_after_the_first_compilation_nothing_is_compiled(tmp_path: Path) -> None:
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    command = [sys.executable, "-c", SCRIPT]
    first = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=400, check=False
    )
    assert first.returncode == 0, first.stderr
    assert "Compiling the numerical kernels" in first.stdout
    again = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=400, check=False
    )
    assert again.returncode == 0, again.stderr
    assert "Compiling" not in again.stdout


def test_kernels_of_versions_long_gone_are_forgotten(tmp_path: Path) -> None:
    ours, old, recent, other = (
        tmp_path / name for name in ("kernels-a", "kernels-b", "kernels-c", "something")
    )
    month = time.time() - 31 * 86400
    for folder in (ours, old, recent, other):
        folder.mkdir()
        (folder / "compiled-by-numba-0").touch()
    for path in (ours, old, other, recent):
        os.utime(path, (month, month))
    for folder in (ours, old, other):
        os.utime(folder / "compiled-by-numba-0", (month, month))
    forget_old_kernels(ours)
    assert {folder.name for folder in tmp_path.iterdir()} == {"kernels-a", "kernels-c", "something"}
