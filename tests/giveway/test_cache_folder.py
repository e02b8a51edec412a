"""Nothing is loaded from a folder in which somebody else can write."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from giveway import _cache_folder
from giveway._cache_folder import forget_oldest, objection

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="modes of Unix")


@pytest.mark.parametrize(
    ("outer", "inner", "why"),
    [
        (0o755, 0o755, ""),
        (0o755, 0o775, "others may write in {inner}"),
        (0o777, 0o755, "others may write in {outer}"),
        (0o1777, 0o755, ""),  # as a folder in /tmp
        (0o700, 0o775, ""),  # nobody else gets there
        (0o755, 0o1777, "others may write in {inner}"),
    ],
)
def test_a_folder_is_safe_if_only_its_owner_can_write_it(outer, inner, why, monkeypatch, tmp_path):
    folder = tmp_path / "outer" / "inner"
    folder.mkdir(parents=True)
    (tmp_path / "outer").chmod(outer)
    folder.chmod(inner)
    _visible_to_all(monkeypatch, tmp_path)
    assert objection(folder) == why.format(outer=tmp_path / "outer", inner=folder)


def _visible_to_all(monkeypatch, tmp_path):
    """Let the parents of ``tmp_path``, one of which is private, count as the root folder does."""
    known, stat = set(tmp_path.resolve().parents) | {tmp_path.resolve()}, Path.stat
    monkeypatch.setattr(Path, "stat", lambda path: stat(Path("/") if path in known else path))


def test_the_folder_of_another_user_is_used_only_if_it_is_named(monkeypatch, tmp_path):
    folder = tmp_path / "cache"
    folder.mkdir()
    if os.getuid() == 0:
        os.chown(folder, 12345, 12345)
    else:
        monkeypatch.setattr(os, "getuid", lambda: 12345)
    assert "belongs to another user" in objection(folder)
    assert objection(folder, named=True) == ""


SCRIPT = """
import os, subprocess, sys
from giveway._cache_folder import cache_folder
print(cache_folder(), oct(os.stat(cache_folder()).st_mode & 0o777))
if len(sys.argv) > 1:
    sys.stdout.flush()
    subprocess.run([sys.executable, "-c", sys.argv[1]], check=True)
"""


def test_without_a_safe_folder_a_fresh_one_serves_a_process_and_its_children(tmp_path):
    (tmp_path / "no_folder").touch()
    elsewhere = {"XDG_CACHE_HOME": tmp_path / "no_folder", "HOME": tmp_path / "no_folder"}
    kept = {k: v for k, v in os.environ.items() if k not in {"NUMBA_CACHE_DIR", "GIVEWAY_CACHE"}}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, SCRIPT],
        env={**kept, **elsewhere, "TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    parent, child = done.stdout.splitlines()
    assert parent == child
    assert parent.startswith(f"{tmp_path}/giveway-cache-")
    assert parent.endswith("0o700")
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith(f"note: {tmp_path / 'no_folder'}")
    assert [path.name for path in tmp_path.iterdir()] == ["no_folder"]  # it is removed in the end


def test_the_entries_that_were_written_last_are_kept(monkeypatch, tmp_path):
    monkeypatch.setattr(_cache_folder, "_MANY", 2)
    for age, name in enumerate("abcd"):
        (tmp_path / name).mkdir() if name in "ad" else (tmp_path / name).touch()
        os.utime(tmp_path / name, (age, age))
    forget_oldest(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"c", "d"}
