"""A new scenario is written whole or not at all, with the same bytes each time."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING

import pytest

from giveway.errors import ConfigError, ResultsError, ScenarioError
from giveway.scenario_builder import EXAMPLE, write_scenario
from sumo_scenarios import find
from sumo_scenarios.build import build

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def drawn(tmp_path: Path) -> Path:
    file = tmp_path / "drawn.toml"
    file.write_text(EXAMPLE)
    return file


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def test_the_same_street_gives_the_same_bytes(drawn: Path, tmp_path: Path) -> None:
    one, warnings = write_scenario(drawn, tmp_path / "one")
    other, _ = write_scenario(drawn, tmp_path / "other")
    assert contents(one) == contents(other)
    assert warnings == 0
    assert find(one).description == "A street of 220 m, 1 + 1 lanes, 30 km/h, crossings: 1 x zebra"


def test_the_network_can_be_built_again_from_its_sources(drawn: Path, tmp_path: Path) -> None:
    folder, _ = write_scenario(drawn, tmp_path / "town")
    before = contents(folder)
    build(str(folder))
    assert contents(folder) == before


def test_a_name_that_sumo_would_split_is_mended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my, town & <I>.toml").write_text("")
    folder, _ = write_scenario(tmp_path / "my, town & <I>.toml")
    assert folder.name == "my_town_I_"
    assert find(folder).config_file.name == "my_town_I_.sumocfg"


def test_a_scenario_is_replaced_only_with_force(drawn: Path, tmp_path: Path) -> None:
    folder, _ = write_scenario(drawn, tmp_path / "town")
    with pytest.raises(ResultsError, match="--force"):
        write_scenario(drawn, folder)
    drawn.write_text("speed = 50.0")
    write_scenario(drawn, folder, force=True)
    assert 'speed="13.89"' in (folder / "drawn.edg.xml").read_text()


def test_what_fails_leaves_the_former_scenario(drawn: Path, tmp_path: Path) -> None:
    folder, _ = write_scenario(drawn, tmp_path / "town")
    before = contents(folder)
    drawn.write_text("length = 1.0")
    with pytest.raises(ConfigError):
        write_scenario(drawn, folder, force=True)
    assert contents(folder) == before


def test_files_of_others_are_kept(drawn: Path, tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "thesis.txt").touch()
    with pytest.raises(ResultsError, match=r"thesis\.txt"):
        write_scenario(drawn, mine, force=True)


def test_without_netconvert_the_extra_is_named(
    drawn: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.delenv("SUMO_HOME", raising=False)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(ScenarioError, match=r"pip install 'giveway\[new\]'"):
        write_scenario(drawn, tmp_path / "town")
    assert not (tmp_path / "town").exists()
