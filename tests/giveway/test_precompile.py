"""The compilation after installation is complete: no run waits for the compiler again."""

import os
import subprocess
import sys
import time
from pathlib import Path

from giveway.precompile import forget_old_kernels

# Numba's cache is the suite's own, in which nearly everything is compiled already: what counts is
# whether a run makes numba look for a kernel that the compilation has not passed through.
SCRIPT = """
import sys
from pathlib import Path
from numba.core.dispatcher import Dispatcher
from rich.console import Console
import giveway
from giveway import precompile

precompile.kernel_cache = lambda: Path(sys.argv[1])  # where the marker is

def looked_for():
    rooms = {"giveway", "controller", "pedestrian_model"}
    counts = {}
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] in rooms:
            for key, value in vars(module).items():
                if isinstance(value, Dispatcher):
                    stats = value.stats
                    looks = (*stats.cache_misses.values(), *stats.cache_hits.values())
                    counts[name, key] = sum(looks)
    return counts

for _ in range(2):
    precompile.compile_kernels_once(Console())
for _ in range(2):
    precompile.compile_kernels_once(Console(), threads=2)
from pedestrian_model.vci import threads
assert threads.step_domain.stats.cache_hits or threads.step_domain.stats.cache_misses
before = looked_for()
for settings in (
    {"seed": 4, "twin": True}, {"seed": 3, "controller": "pid"}, {"scenario": "street"}
):
    giveway.run(settings).summary
late = {key for key, count in looked_for().items() if count > before.get(key, 0)}
assert not late, late
"""


def test_after_the_first_compilation_nothing_is_compiled(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=400,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("Compiling the numerical kernels") == 1
    assert done.stdout.count("Compiling the kernels of several threads") == 1


def test_kernels_of_versions_long_gone_are_forgotten(tmp_path: Path) -> None:
    ours, old, recent, other = (
        tmp_path / name for name in ("kernels-a", "kernels-b", "kernels-c", "something")
    )
    month = time.time() - 31 * 86400
    for folder in (ours, old, recent, other):
        folder.mkdir()
        (folder / "compiled-for-a-cpu").touch()
    for path in (ours, old, other, recent):
        os.utime(path, (month, month))
    for folder in (ours, old, other):
        os.utime(folder / "compiled-for-a-cpu", (month, month))
    forget_old_kernels(ours)
    assert {folder.name for folder in tmp_path.iterdir()} == {"kernels-a", "kernels-c", "something"}
