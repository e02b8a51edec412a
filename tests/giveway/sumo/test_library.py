"""A child process imports libsumo without what its Python modules import for their tools."""

import subprocess
import sys

import pytest


@pytest.mark.parametrize("needed", [(), ("numpy",)])
def test_the_child_spares_itself_what_it_has_no_use_for(needed) -> None:
    """And does not when libsumo cannot do without it any more."""
    program = (
        "import builtins, sys\n"
        "from giveway.sumo import library\n"
        f"needed = {needed!r}\n"
        "importing = builtins.__import__\n"
        "def strict(name, *rest, **more):\n"
        "    if name == 'libsumo':\n"
        "        for module in needed:\n            importing(module)\n"
        "    return importing(name, *rest, **more)\n"
        "builtins.__import__ = strict\n"
        "sumo = library.import_bare_libsumo()\n"
        "print(sumo.simulation.getVersion()[1], 'numpy.linalg' in sys.modules)\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.split()[:1] == ["SUMO"]
    assert ended.stdout.split()[-1] == str(bool(needed))
