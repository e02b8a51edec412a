"""A hostile archive is refused before a command loads anything for its work."""

from __future__ import annotations

import subprocess
import sys
import zipfile

import pytest

PROGRAM = """
import sys
from giveway.cli import main
try:
    main(sys.argv[1:])
finally:
    print("loaded:", *sorted({"numpy", "numba", "pandas", "osqp", "libsumo"} & set(sys.modules)))
"""


@pytest.fixture
def bomb(tmp_path):
    path = tmp_path / "bomb.fmu"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", "<fmiModelDescription/>")
        archive.writestr("resources/zeros", b"\0" * (32 << 20))
    return path


@pytest.mark.parametrize("named", ["flag", "file", "ego"])
def test_a_zip_bomb_is_refused_before_run_loads_anything_else(bomb, tmp_path, named):
    words = ["--vehicle", bomb]
    if named != "flag":
        table = "[vehicle]" if named == "file" else "[[egos]]\n[egos.vehicle]"
        (tmp_path / "run.toml").write_text(f'{table}\nfmu = "bomb.fmu"\n', encoding="utf-8")
        words = ["--config", "run.toml"]
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, "run", *map(str, words)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=180,
        check=False,
    )
    assert done.returncode != 0
    assert done.stderr.startswith(f"error: {bomb}: member 'resources/zeros': a zip bomb")
    assert done.stderr.count("\n") == 1
    loaded = done.stdout.split()
    assert loaded[0] == "loaded:"
    assert not {"numba", "pandas", "osqp", "libsumo"} & set(loaded)


def test_an_fmu_that_is_not_there_is_left_to_the_command(tmp_path):
    from giveway.cli.guards.archive_check import require_archives

    require_archives(None, {"vehicle": {"fmu": str(tmp_path / "missing.fmu")}})
    require_archives(None, {"vehicle": {"fmu": "fmi2"}})
    require_archives(None, {})
