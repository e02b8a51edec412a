"""The networks in the repository are what netconvert makes of the sources beside them."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from sumo_scenarios import BuildError, Scenario, available, find
from sumo_scenarios.build import build, convert, main, netconvert_and_home

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.fixture
def own_copy(tmp_path: Path) -> Path:
    """The street's folder as a user's own."""
    return Path(shutil.copytree(find("street").folder, tmp_path / "own"))


def test_rebuilding_gives_the_same_bytes(scenario: Scenario, tmp_path: Path) -> None:
    rebuilt = build(scenario.name, out=tmp_path)
    assert rebuilt.name == f"{scenario.name}.net.xml"
    assert rebuilt.read_bytes() == (scenario.folder / rebuilt.name).read_bytes()


def test_folder_clock_and_language_do_not_show_in_the_bytes(tmp_path: Path) -> None:
    environment = {key: value for key, value in os.environ.items() if key != "SUMO_HOME"}
    environment |= {"TZ": "Pacific/Auckland", "LC_ALL": "de_DE.UTF-8"}
    root = Path(str(find("street").folder)).parent.parent
    environment["PYTHONPATH"] = str(root)
    command = [sys.executable, "-m", "sumo_scenarios.build", "--out", "networks"]
    subprocess.run(command, check=True, cwd=tmp_path, env=environment, capture_output=True)
    for name in available():
        rebuilt = tmp_path / "networks" / f"{name}.net.xml"
        assert rebuilt.read_bytes() == (find(name).folder / rebuilt.name).read_bytes()


def test_the_bytes_hold_no_date_and_no_path(scenario: Scenario) -> None:
    text = (scenario.folder / f"{scenario.name}.net.xml").read_bytes().decode("utf-8")
    assert "generated on" not in text
    assert "/tmp" not in text
    assert "\r" not in text


def test_a_folder_of_ones_own_is_built_in_place(own_copy: Path) -> None:
    network = own_copy / "street.net.xml"
    network.unlink()
    assert build(str(own_copy)) == network
    assert network.read_bytes() == (find("street").folder / network.name).read_bytes()


def test_netconverts_reason_is_in_the_message(own_copy: Path) -> None:
    edges = own_copy / "street.edg.xml"
    edges.write_text(edges.read_text().replace('to="east"', 'to="nowhere"'))
    with pytest.raises(BuildError, match="to-node 'nowhere' is not known"):
        build(str(own_copy))


def test_a_folder_without_sources_is_refused(own_copy: Path) -> None:
    (own_copy / "street.netccfg").unlink()
    with pytest.raises(BuildError, match=r"street\.netccfg is missing"):
        build(str(own_copy))


def test_without_netconvert_the_message_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.delenv("SUMO_HOME", raising=False)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(BuildError, match=r"pip install 'giveway\[new\]'"):
        build("street")


def test_a_netconvert_of_the_search_path_serves_but_for_its_tables(
    own_copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that lies apart from SUMO's data builds drawn networks, but knows no map's tags."""
    program, home = netconvert_and_home()
    (tmp_path / "bin").mkdir()
    link = tmp_path / "bin" / program.name
    link.write_text(f'#!/bin/sh\nSUMO_HOME={home} exec {program} "$@"\n')
    link.chmod(0o755)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.delenv("SUMO_HOME", raising=False)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/usr/bin:/bin")
    network = build(str(own_copy))
    assert network.read_bytes() == (find("street").folder / network.name).read_bytes()
    with pytest.raises(BuildError, match="no such folder; set SUMO_HOME"):
        convert([], typemaps=["osmNetconvert.typ.xml"])


def test_the_command_line_prints_what_it_wrote(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["street", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'street.net.xml'}\n"


def test_the_command_line_answers_a_mistyped_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stret"]) == 1
    assert "did you mean 'street'?" in capsys.readouterr().err


def test_a_run_writes_nothing_into_the_folder(
    scenario: Scenario,
    tmp_path: Path,
    probe: Callable[..., dict[str, Any]],
    settings: Callable[[Scenario], dict[str, Any]],
) -> None:
    folder = Path(shutil.copytree(scenario.folder, tmp_path / "read only"))
    files = sorted(folder.iterdir())
    before = {file.name: (file.read_bytes(), file.stat().st_mtime_ns) for file in files}
    for path in (*files, folder):
        path.chmod(path.stat().st_mode & ~0o222)
    try:
        found = find(folder)
        probe("drive", found.config_file, 1.0, ego=settings(found)["ego"])
        probe("move_ghosts", found.config_file, 1.0, crowd=settings(found)["crowd"])
    finally:
        folder.chmod(0o755)
    after = sorted(folder.iterdir())
    assert {file.name: (file.read_bytes(), file.stat().st_mtime_ns) for file in after} == before
