"""The compilation after installation is complete: no run waits for the compiler again."""

import os
import subprocess
import sys
from pathlib import Path

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
