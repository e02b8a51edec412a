"""Unpacking: what is asked for, and never outside."""

from __future__ import annotations

import os
import zipfile

import pytest

from fmus.archive.archive_check import extract, open_archive
from fmus.errors import FmuArchiveError, FmuFileError

DESCRIPTION = b'<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0"/>'
MEGABYTE = 1 << 20


# ---- unpacking ----


def test_only_what_is_asked_for_is_unpacked(archive, tmp_path):
    members = ("resources/a.txt", "resources/deep/b.txt", "binaries/linux64/c.so", "sources/d.c")
    path = archive(*((name, name.encode()) for name in members))
    folder = tmp_path / "out"
    folder.mkdir()
    extract(open_archive(path), folder, lambda n: n.startswith(("resources/", "binaries/")))
    unpacked = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*.*")}
    assert unpacked == {name: name.encode() for name in members[:3]}


def test_nothing_is_written_through_a_link_that_waits_there(archive, tmp_path, refused):
    path = archive(("resources/a.txt", b"evil"))
    folder, victim = tmp_path / "out", tmp_path / "victim"
    (folder / "resources").mkdir(parents=True)
    (folder / "resources" / "a.txt").symlink_to(victim)
    with refused(FmuFileError, path, "resources/a.txt", "exists"):
        extract(open_archive(path), folder, lambda _name: True)
    assert not victim.exists()


def test_a_file_that_changed_since_it_was_examined(archive, tmp_path, refused):
    path = archive(("resources/a.txt", b"good"))
    examined = open_archive(path)
    path.write_bytes(archive(("resources/b.txt", b"evil" * 100), name="other.fmu").read_bytes())
    folder = tmp_path / "out"
    folder.mkdir()
    with refused(FmuArchiveError, path, "damaged"):
        extract(examined, folder, lambda _name: True)


def test_damage_in_a_large_archive_shows_when_it_is_unpacked(
    archive, tmp_path, monkeypatch, refused
):
    monkeypatch.setattr("fmus.archive.archive_check.CHECKED_AT_ONCE", 0)
    info = zipfile.ZipInfo("resources/a.txt")
    path = archive((info, b"good " * 20))
    data = path.read_bytes()
    assert b"good good" in data
    path.write_bytes(data.replace(b"good good", b"evil good", 1))
    with refused(FmuArchiveError, path, "resources/a.txt"):
        extract(open_archive(path), tmp_path, lambda _name: True)


@pytest.mark.skipif(os.name != "posix", reason="files have no such modes")
def test_only_what_may_be_executed_may_be_executed(archive, tmp_path):
    modes = {"resources/tool": 0o100755, "resources/setuid": 0o104711, "resources/data": 0o100644}
    members = []
    for name, mode in modes.items():
        members.append((zipfile.ZipInfo(name), b"#!/bin/sh\n"))
        members[-1][0].external_attr = mode << 16
    extract(open_archive(archive(*members)), tmp_path, lambda name: name.startswith("resources/"))
    found = {name: (tmp_path / name).stat().st_mode & 0o7777 for name in modes}
    usual = found["resources/data"]
    assert not usual & 0o111
    with_x = usual | (usual & 0o444) >> 2
    assert found["resources/tool"] == found["resources/setuid"] == with_x
