"""Where numba keeps compiled kernels: chosen when it is first imported, and only then."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

AFTER = "print(numba.config.CACHE_DIR == os.environ['NUMBA_CACHE_DIR'], numba.config.CACHE_DIR)"


def said(script: str, home: Path, **more: str) -> str:
    kept = {k: v for k, v in os.environ.items() if k not in {"NUMBA_CACHE_DIR", "XDG_CACHE_HOME"}}
    done = subprocess.run(
        [sys.executable, "-c", f"import os, sys; {script}"],
        env={**kept, "HOME": str(home), **more},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_importing_giveway_chooses_nothing_yet(tmp_path: Path) -> None:
    script = "import giveway; print('NUMBA_CACHE_DIR' in os.environ, 'numba' in sys.modules)"
    assert said(script, tmp_path) == "False False"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the cache is not below HOME")
@pytest.mark.parametrize("order", ["import giveway, numba", "import numba, giveway"])
def test_whoever_imports_numba_first_the_users_cache_is_taken(order: str, tmp_path: Path) -> None:
    agrees, folder = said(f"{order}; {AFTER}", tmp_path).split()
    assert agrees == "True"
    assert folder.startswith(str(tmp_path / ".cache" / "giveway" / "kernels-"))


def test_the_users_own_choice_wins(tmp_path: Path) -> None:
    chosen = str(tmp_path / "mine")
    script = f"import giveway, numba; {AFTER}"
    assert said(script, tmp_path, NUMBA_CACHE_DIR=chosen) == f"True {chosen}"
