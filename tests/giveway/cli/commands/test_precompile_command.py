"""``giveway precompile`` keeps all kernels where a user wants them, if that is safe."""

import os
import sys
from pathlib import Path

import pytest

from giveway import precompile
from giveway._kernels.cache import kernel_place
from giveway.cli.commands.precompile_command import precompile_command
from giveway.errors import InstallationError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="modes of Unix")


@pytest.fixture(autouse=True)
def choice(monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")  # restores what the command sets
    kernel_place.cache_clear()
    yield
    kernel_place.cache_clear()


def test_all_kernels_go_into_the_folder(monkeypatch, capsys, tmp_path):
    def compile_kernels_once(_console, *, threads):
        (Path(os.environ["NUMBA_CACHE_DIR"]) / f"for-{threads}-threads").touch()

    monkeypatch.setattr(precompile, "compile_kernels_once", compile_kernels_once)
    into = tmp_path / "image" / "kernels"
    precompile_command(into)
    kernels, hint = capsys.readouterr().out.splitlines()
    assert kernels.startswith(f"Kernels in {into}/kernels-")
    assert hint == f"Set NUMBA_CACHE_DIR={into} where giveway runs."
    assert (into / "for-2-threads").exists()
    assert into.stat().st_mode & 0o755 == 0o755  # for the users of the image, too


def test_a_folder_in_which_others_may_write_is_refused(monkeypatch, tmp_path):
    tmp_path.chmod(0o777)
    parents, stat = set(tmp_path.resolve().parents), Path.stat
    monkeypatch.setattr(Path, "stat", lambda path: stat(Path("/") if path in parents else path))
    with pytest.raises(InstallationError, match=f"others may write in {tmp_path}; expected"):
        precompile_command(tmp_path / "kernels")
