"""Code that only a results folder names: whose folder it is, and which content the code has."""

from __future__ import annotations

import json
import re
import shutil
import zipfile
from typing import TYPE_CHECKING

import pytest
from support.runs import foreign

from fmus import bundled_fmu
from giveway import run
from giveway.config.files.layers import Layer, read_toml
from giveway.config.files.loading import load
from giveway.config.files.trust import is_own_folder
from giveway.errors import ConfigError
from giveway.gate import MANIFEST, fingerprint_of
from giveway.results.inputs import require_recorded
from giveway.run_data.seal import SEAL, sealed
from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from support.commands import Typed


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a short run whose vehicle is ``car.fmu`` beside them."""
    place = tmp_path_factory.mktemp("made")
    with zipfile.ZipFile(bundled_fmu("2.0")) as ours:
        members = {name: ours.read(name) for name in ours.namelist()}
    with zipfile.ZipFile(place / "car.fmu", "w") as theirs:  # other bytes
        for name, content in members.items():
            theirs.writestr(name, content)
    folder = place / "results"
    run({"time_limit": 0.3, "crowd": {"pedestrians": 1}}, results=folder, pictures=False)
    config = folder / "config.toml"
    named = f'fmu = "{place / "car.fmu"}"'
    text, count = re.subn(r'(?m)^fmu = "[^"]*"', named, config.read_text())
    assert count == 1
    config.write_text(text)
    manifest = json.loads((folder / MANIFEST).read_text())
    names = manifest.pop(SEAL)["files"]
    del manifest["maker"]
    manifest["vehicles"]["ego"] |= fingerprint_of(place / "car.fmu") | {"bundled": False}
    (folder / MANIFEST).write_text(json.dumps(sealed(manifest, folder, names)))
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    """A copy of the results, which names the same FMU."""
    return shutil.copytree(made, tmp_path / "run")


def test_own_results_load_the_vehicle_that_they_were_made_with(folder: Path) -> None:
    assert is_own_folder(folder)
    assert load([read_toml(folder / "config.toml")])


def test_foreign_results_need_the_users_word_for_a_vehicle(folder: Path, made: Path) -> None:
    layer, car = read_toml(foreign(folder) / "config.toml"), str(made.parent / "car.fmu")
    with pytest.raises(ConfigError, match=r"somebody else's results folder names code.*--trust"):
        load([layer])
    with pytest.raises(ConfigError, match="somebody else's results folder"):
        load([layer], trusted=["other.fmu"])
    for name in (car, "car.fmu"):
        assert load([layer], trusted=[name])
    named = Layer("command line", {"vehicle": {"fmu": car}}, from_flags=True)
    assert load([layer, named])


def test_a_scenario_that_foreign_results_name_brings_no_vehicle(
    folder: Path, made: Path, tmp_path: Path
) -> None:
    theirs = shutil.copytree(find("shared_space").config_file.parent, tmp_path / "theirs")
    settings = theirs / "shared_space.giveway.toml"
    car = made.parent / "car.fmu"
    settings.write_text(settings.read_text() + f'\n[vehicle]\nfmu = "{car}"\n')
    scenario = f'scenario = "{theirs / "shared_space.sumocfg"}"\n'
    (foreign(folder) / "config.toml").write_text(scenario)
    with pytest.raises(ConfigError, match=r"giveway\.toml: .*somebody else's results folder"):
        load([read_toml(folder / "config.toml")])
    (tmp_path / "my.toml").write_text(scenario)
    assert load([read_toml(tmp_path / "my.toml")])


def test_foreign_results_pass_no_options_to_sumo(folder: Path, tmp_path: Path) -> None:
    text = f'[sumo]\noptions = "--log {tmp_path / "precious"}"\n'
    (foreign(folder) / "config.toml").write_text(text)
    layer = read_toml(folder / "config.toml")
    with pytest.raises(ConfigError, match="passes options to SUMO"):
        load([layer])
    assert load([layer, Layer("command line", {"sumo": {"options": ""}}, from_flags=True)])
    (tmp_path / "my.toml").write_text(text)
    assert load([read_toml(tmp_path / "my.toml")])


def test_settings_that_were_changed_are_not_ones_own(folder: Path) -> None:
    config = folder / "config.toml"
    config.write_text(config.read_text() + "\n")
    assert not is_own_folder(folder)
    with pytest.raises(ConfigError, match="somebody else's"):
        load([read_toml(config)])


@pytest.mark.parametrize("whose", ["own", "foreign"])
def test_a_vehicle_that_was_swapped_is_not_loaded(
    folder: Path, made: Path, tmp_path: Path, whose: str
) -> None:
    (tmp_path / "elsewhere").mkdir()
    text = (folder / "config.toml").read_text()
    car = shutil.copy(made.parent / "car.fmu", folder / "car.fmu")
    text = text.replace(str(made.parent / "car.fmu"), str(car))
    (folder / "config.toml").write_text(text)
    manifest = json.loads((folder / MANIFEST).read_text())
    names = manifest.pop(SEAL)["files"]
    del manifest["maker"]
    (folder / MANIFEST).write_text(json.dumps(sealed(manifest, folder, names)))
    if whose == "foreign":
        foreign(folder)
    layer = read_toml(folder / "config.toml")
    assert load([layer], trusted=["car.fmu"])
    with car.open("ab") as file:
        file.write(b"\0")
    with pytest.raises(ConfigError, match="another content of this file"):
        load([layer], trusted=["car.fmu"])


def test_foreign_results_without_a_hash_are_not_believed(folder: Path) -> None:
    manifest = json.loads((folder / MANIFEST).read_text())
    del manifest["vehicles"]["ego"]["sha256"], manifest["inputs"]
    (folder / MANIFEST).write_text(json.dumps(manifest))
    with pytest.raises(ConfigError, match="has no hash of this code"):
        load([read_toml(folder / "config.toml")], trusted=["car.fmu"])


def test_a_replay_of_foreign_results_makes_no_run_and_says_so(
    folder: Path, type_here: Callable[..., Typed]
) -> None:
    done = type_here("replay", foreign(folder))
    (note,) = done.stderr.splitlines()
    assert done.returncode == 0
    assert note.startswith("note: No predictions: the run could not be made again (error: ")
    assert "somebody else's results folder names code" in note
    assert (folder / "replay.html").stat().st_size > 10_000


def test_foreign_results_are_repeated_with_the_recorded_files_only(
    folder: Path, tmp_path: Path
) -> None:
    mine = shutil.copytree(find("shared_space").config_file.parent, tmp_path / "mine")
    settings = {"scenario": str(mine / "shared_space.sumocfg"), "time_limit": 0.1}
    run(settings | {"crowd": {"pedestrians": 0}}, results=tmp_path / "r", pictures=False)
    config, scenario = load([read_toml(tmp_path / "r" / "config.toml")])
    routes = next(mine.glob("*.net.xml"))
    for change in (False, True):
        if change:
            routes.write_text(routes.read_text() + "<!-- other -->")
        require_recorded(tmp_path / "r", config, scenario)
        theirs = foreign(shutil.copytree(tmp_path / "r", tmp_path / f"theirs{change}"))
        if not change:
            require_recorded(theirs, config, scenario)
            continue
        with pytest.raises(ConfigError, match=r"net\.xml: has another content"):
            require_recorded(theirs, config, scenario)


def test_code_that_giveway_itself_declares_needs_nobodys_word(tmp_path: Path) -> None:
    settings = {"time_limit": 0.2, "controller": "idm", "perception.sensor": "sight"}
    run(settings | {"crowd.pedestrians": 1}, results=tmp_path / "r", pictures=False)
    config, _ = load([read_toml(foreign(tmp_path / "r") / "config.toml")])
    assert (config.controller, config.perception.sensor) == ("idm", "sight")
