"""``giveway export run``: one line for what cannot be, a file for what can."""

from __future__ import annotations

import shutil
import sys

import pytest
from support.runs import unseal

import giveway


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("export") / "drive"
    crowd = {"pedestrians": 4}
    giveway.run({"time_limit": 1.0, "crowd": crowd}, results=folder, pictures=False)
    return folder


def test_a_file_named_after_the_run_is_written_beside_it(made, type_here, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    typed = type_here("export", "run", made, "--format", "pedpy")
    assert typed.returncode == 0, typed.stderr
    assert "4 people at 20 frames/s, for PedPy" in typed.stdout
    assert (made.parent / "drive.txt").is_file()
    assert list(tmp_path.iterdir()) == []
    again = type_here("export", "run", made, "--format", "pedpy")
    assert again.returncode != 0
    assert "drive.txt: exists; replace it with --force" in again.stderr
    assert type_here("export", "run", made, "-f", "pedpy", "--force").returncode == 0
    (made.parent / "drive.txt").unlink()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "--format: missing; expected one of fcd, pedpy"),
        (["--format", "mp5"], "--format mp5: no such format; did you mean 'mp4'?"),
        (["--format", "gif", "--out", "film.mp4"], "expected the name of a .gif file"),
        (["--format", "pedpy", "--step", "0"], "--step 0: expected 0.001 to 10 [s]"),
        (["--format", "geojson"], "no projection"),
        pytest.param(
            ["--format", "mp4", "--out", "/proc/film.mp4"],
            "/proc/film.mp4: cannot be written",
            marks=pytest.mark.skipif(sys.platform != "linux", reason="/proc"),
        ),
    ],
)
def test_what_cannot_be_is_one_line_and_leaves_nothing(
    made, type_here, tmp_path, monkeypatch, words, said
):
    monkeypatch.chdir(tmp_path)
    typed = type_here("export", "run", made, *words)
    assert typed.returncode != 0
    assert said in typed.stderr
    assert len(typed.stderr.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
    assert list(made.parent.iterdir()) == [made]


def test_a_folder_without_a_run(type_here, tmp_path):
    typed = type_here("export", "run", tmp_path, "--format", "fcd")
    assert typed.returncode != 0
    assert "no run in it" in typed.stderr


def test_a_run_whose_scenario_is_gone(made, type_here, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    unseal(shutil.copytree(made, tmp_path / "moved"))
    config = tmp_path / "moved" / "config.toml"
    text = config.read_text(encoding="utf-8").replace('"shared_space"', '"gone.sumocfg"')
    config.write_text(text, encoding="utf-8")
    typed = type_here("export", "run", "moved", "--format", "fcd")
    assert typed.returncode != 0
    note, error = typed.stderr.splitlines()
    assert note.startswith("note: moved: has no seal")
    assert "gone.sumocfg" in error
