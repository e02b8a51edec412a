"""The folder for unpacked FMUs: not one from which nothing may be loaded."""

from __future__ import annotations

import os
import tempfile
from types import SimpleNamespace

import pytest

from fmus.archive import place
from fmus.errors import FmuFileError

needs_flags = pytest.mark.skipif(not hasattr(os, "ST_NOEXEC"), reason="no such flag here")


def test_usually_the_folder_for_temporary_files():
    if not place.place_note():
        assert str(place.unpacking_place()) == tempfile.gettempdir()


@needs_flags
def test_another_folder_is_tried_and_a_noexec_one_named(tmp_path, monkeypatch):
    for name in ("noexec", "home", "here"):
        (tmp_path / name).mkdir()
    (tmp_path / "home/.cache").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "noexec"))
    forbidding = {str(tmp_path / "noexec"), "/tmp", "/var/tmp"}

    def flags(folder):
        return SimpleNamespace(f_flag=os.ST_NOEXEC if str(folder) in forbidding else 0)

    monkeypatch.setattr(os, "statvfs", flags)
    assert place.unpacking_place() == tmp_path / "home/.cache"
    assert place.place_note().startswith(f"TMPDIR {tmp_path / 'noexec'} is mounted with noexec")
    forbidding.add(str(tmp_path / "home/.cache"))
    assert place.unpacking_place() == tmp_path / "here"
    forbidding.add(str(tmp_path / "here"))
    with pytest.raises(FmuFileError, match=r"noexec: mounted with noexec.*TMPDIR"):
        place.unpacking_place()
