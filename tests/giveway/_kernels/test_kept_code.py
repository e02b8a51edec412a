"""Compiled code is used if it is what was kept under its name, byte for byte."""

import os

import pytest

from giveway._cache_folder import remark
from giveway._kernels.kept_code import damaged, read, write

CODE = b"machine code" * 100


@pytest.fixture
def file(tmp_path):
    remark.cache_clear()
    write(tmp_path / "a.kernel", CODE)
    return tmp_path / "a.kernel"


def emptied(file):
    file.write_bytes(b"")


def halved(file):
    file.write_bytes(file.read_bytes()[:600])


def bit_turned(file):
    content = bytearray(file.read_bytes())
    content[-1] ^= 1
    file.write_bytes(content)


def exchanged(file):
    write(file.with_name("b.kernel"), CODE)
    file.with_name("b.kernel").replace(file)


def a_folder(file):
    file.unlink()
    file.mkdir()


def a_pipe(file):
    file.unlink()
    os.mkfifo(file)


def endless(file):
    file.unlink()
    file.symlink_to("/dev/zero")


@pytest.mark.parametrize(
    "damage", [emptied, halved, bit_turned, exchanged, a_folder, a_pipe, endless]
)
def test_what_is_damaged_is_named_and_not_used(damage, file, capsys):
    if damage in {a_pipe, endless} and not hasattr(os, "mkfifo"):
        pytest.skip("files of Unix")
    assert (read(file), list(damaged(file.parent))) == (CODE, [])
    damage(file)
    assert list(damaged(file.parent)) == [file]
    assert [read(file), read(file)] == [b"", b""]
    line = f"note: {file.parent}: compiled code is damaged; what is needed is compiled anew\n"
    assert capsys.readouterr().err == line


def test_what_is_missing_is_not_damaged(tmp_path, capsys):
    assert read(tmp_path / "a.kernel") == b""
    assert capsys.readouterr().err == ""


@pytest.mark.skipif(os.name == "nt", reason="modes of Unix")
def test_nobody_else_may_write_what_is_kept(file):
    before = os.umask(0)
    try:
        write(file.with_name("c.kernel"), CODE)
    finally:
        os.umask(before)
    assert file.with_name("c.kernel").stat().st_mode & 0o777 == 0o644


def test_code_that_cannot_be_kept_costs_a_note(tmp_path, capsys):
    remark.cache_clear()
    for _ in range(2):
        write(tmp_path / "no_folder" / "a.kernel", CODE)
    (line,) = capsys.readouterr().err.splitlines()
    assert "compiled code cannot be kept (No such file or directory)" in line
