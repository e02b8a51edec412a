"""Completions for the shell."""

from pathlib import Path

import pytest

from giveway.cli.completion import complete_scenario, complete_study


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a scenario, a study, another file and folders."""
    for name in ("town.sumocfg", "mine.toml", "notes.txt"):
        (tmp_path / name).touch()
    for name in ("streets", ".git"):
        (tmp_path / name).mkdir()
    (tmp_path / "streets" / "grid.sumocfg").touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("folder")
def test_bundled_scenarios_and_configurations_begin_so() -> None:
    assert complete_scenario("shared") == ["shared_space"]
    assert complete_scenario("tow") == ["town.sumocfg"]
    assert complete_scenario("st") == ["street", "streets/"]


@pytest.mark.usefixtures("folder")
def test_in_a_folder_its_files_are_offered() -> None:
    assert complete_scenario("streets/") == ["streets/grid.sumocfg"]
    assert complete_scenario("nowhere/") == []


def test_an_absolute_path_stays_absolute(folder: Path) -> None:
    assert complete_scenario(f"{folder}/to") == [f"{folder}/town.sumocfg"]


@pytest.mark.usefixtures("folder")
def test_studies_are_bundled_or_toml_files() -> None:
    assert "mine.toml" in complete_study("")
    assert "town.sumocfg" not in complete_study("")
    assert complete_study("pap") == ["paper"]
