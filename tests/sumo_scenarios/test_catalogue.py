from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sumo_scenarios import Scenario, ScenarioError, available, find


@pytest.fixture
def my_folder(tmp_path: Path) -> Path:
    """A user's own scenario: a folder with one .sumocfg and its settings."""
    folder = tmp_path / "my street"
    folder.mkdir()
    (folder / "evening.sumocfg").write_text("<configuration/>")
    (folder / "evening.giveway.toml").write_text('description = "My street at night"\n')
    return folder


def message(name_or_path: str | Path) -> str:
    with pytest.raises(ScenarioError) as caught:
        find(name_or_path)
    return str(caught.value)


def test_eight_scenarios_are_bundled() -> None:
    known = (
        "crossings",
        "encounter",
        "junction",
        "parked_cars",
        "recorded",
        "school_run",
        "shared_space",
        "street",
    )
    assert available() == known


def test_a_bundled_scenario_is_found_by_name_with_its_settings(scenario: Scenario) -> None:
    assert scenario.config_file == scenario.folder / f"{scenario.name}.sumocfg"
    assert scenario.settings_file == scenario.folder / f"{scenario.name}.giveway.toml"
    assert scenario.config_file.is_file()
    assert scenario.settings_file.is_file()
    assert scenario.folder.is_absolute()


def test_a_description_is_one_line(scenario: Scenario) -> None:
    assert scenario.description
    assert "\n" not in scenario.description


def test_folder_path_and_config_path_find_the_same_scenario(my_folder: Path) -> None:
    by_folder = find(my_folder)
    assert by_folder == find(str(my_folder)) == find(my_folder / "evening.sumocfg")
    assert by_folder == Scenario(
        name="evening",
        folder=my_folder,
        config_file=my_folder / "evening.sumocfg",
        settings_file=my_folder / "evening.giveway.toml",
        description="My street at night",
    )


def test_a_relative_path_is_looked_up_from_the_current_folder(
    my_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(my_folder.parent)
    assert find("my street") == find("./my street/evening.sumocfg") == find(my_folder)


def test_a_tilde_is_the_home_folder(my_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(my_folder.parent))
    monkeypatch.setenv("USERPROFILE", str(my_folder.parent))
    assert find("~/my street") == find(my_folder)


def test_settings_are_optional(my_folder: Path) -> None:
    (my_folder / "evening.giveway.toml").unlink()
    found = find(my_folder)
    assert found.settings_file is None
    assert found.description == ""


def test_a_bundled_name_wins_over_a_folder_unless_dot_slash(
    my_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    local = my_folder.rename(my_folder.with_name("street"))
    monkeypatch.chdir(local.parent)
    assert find("street").folder == find("street").config_file.parent != local
    assert find("./street").folder == local
    assert find(Path("street")).folder == local


def test_a_linked_config_is_taken_where_the_link_is(my_folder: Path, tmp_path: Path) -> None:
    linked = tmp_path / "linked" / "evening.sumocfg"
    linked.parent.mkdir()
    try:
        linked.symlink_to(my_folder / "evening.sumocfg")
    except OSError:
        pytest.skip("this system lets nobody make links")
    assert find(linked).folder == linked.parent


@pytest.mark.parametrize("typo", ["shared_spaec", "sharedspace", "Shared_Space", "shared-space"])
def test_a_mistyped_name_is_answered_with_the_right_one(typo: str) -> None:
    assert message(typo) == (
        f"unknown scenario {typo!r}; did you mean 'shared_space'? "
        "(bundled: crossings, encounter, junction, parked_cars, recorded, school_run, "
        "shared_space, street; or a folder, or a .sumocfg file)"
    )


@pytest.mark.parametrize("nonsense", ["", "   ", "xyzzy", "a\0b"])
def test_nonsense_is_answered_with_what_there_is(nonsense: str) -> None:
    answer = message(nonsense)
    assert ", ".join(available()) in answer
    assert "did you mean" not in answer
    assert "\n" not in answer


@pytest.mark.parametrize("impossible", ["x" * 5000, "~no-such-user/scenario"])
def test_a_path_that_cannot_be_is_refused_in_one_line(impossible: str) -> None:
    answer = message(impossible)
    assert impossible in answer
    assert "\n" not in answer


def test_a_mistyped_path_is_answered_with_its_neighbour(my_folder: Path) -> None:
    answer = message(my_folder / "evning.sumocfg")
    assert f"did you mean {str(my_folder / 'evening.sumocfg')!r}?" in answer
    assert "my street" in message(my_folder.with_name("my-street"))


def test_a_folder_without_a_config_is_refused(tmp_path: Path) -> None:
    assert message(tmp_path) == f"folder {tmp_path} holds no .sumocfg file: expected exactly one"


def test_a_folder_with_two_configs_asks_which(my_folder: Path) -> None:
    shutil.copy(my_folder / "evening.sumocfg", my_folder / "morning.sumocfg")
    assert "evening.sumocfg, morning.sumocfg" in message(my_folder)
    assert find(my_folder / "morning.sumocfg").settings_file is None


def test_another_kind_of_file_is_refused(my_folder: Path) -> None:
    settings = my_folder / "evening.giveway.toml"
    assert message(settings) == (
        f"{settings} is not a scenario: expected a .sumocfg file or its folder"
    )


def test_broken_settings_are_named(my_folder: Path) -> None:
    settings = my_folder / "evening.giveway.toml"
    settings.write_text("[ego]\nroute = [\n")
    assert str(settings) in message(my_folder)
    assert "not valid TOML" in message(my_folder)
    settings.write_bytes(b'description = "\xff"')
    assert "not valid TOML" in message(my_folder)
    settings.write_text("description = 7\n")
    assert message(my_folder) == f"{settings}: description = 7: expected a line of text"


def test_the_older_name_of_a_configuration_is_known_too(my_folder: Path) -> None:
    older = (my_folder / "evening.sumocfg").rename(my_folder / "evening.sumo.cfg")
    found = find(older)
    assert found.name == "evening"
    assert found.settings_file == my_folder / "evening.giveway.toml"
