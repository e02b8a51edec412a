"""``giveway fmu compile`` as a user types it."""

from __future__ import annotations

import zipfile

import pytest

from fmus import bundled_fmu
from giveway.cli import main


@pytest.fixture
def compiled(monkeypatch, capsys, tmp_path):
    """Runs ``giveway fmu compile`` in tmp_path on the shipped FMU without binaries."""
    monkeypatch.chdir(tmp_path)
    with zipfile.ZipFile(bundled_fmu()) as old, zipfile.ZipFile("car.fmu", "w") as new:
        for name in old.namelist():
            if not name.startswith("binaries/"):
                new.writestr(name, old.read(name))

    def run(*words):
        with pytest.raises(SystemExit) as ended:
            main(["fmu", "compile", *words])
        return ended.value.code, *capsys.readouterr()

    return run


def test_a_copy_with_a_binary_is_written_but_not_replaced(compiled, tmp_path):
    code, out, err = compiled("car.fmu", "-o", "here.fmu")
    assert code == 0, err
    assert "Compiled binaries/" in out
    made = (tmp_path / "here.fmu").read_bytes()
    code, _, err = compiled("car.fmu", "-o", "here.fmu")
    assert code == 2
    assert err.startswith("error: here.fmu: exists")
    assert err.count("\n") == 1
    assert (tmp_path / "here.fmu").read_bytes() == made
    code, _, err = compiled("car.fmu", "-o", "car.fmu", "--force")
    assert code == 2


def test_what_cannot_be_compiled_is_one_line(compiled, tmp_path):
    (tmp_path / "no.fmu").write_bytes(b"no archive")
    for name, code in (("no.fmu", 1), ("missing.fmu", 2)):
        found, _, err = compiled(name)
        assert found == code
        assert err.startswith(f"error: {name}: ")
        assert err.count("\n") == 1
