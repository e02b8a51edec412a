"""The seal of a run: tables that are cut, shuffled, changed or of another run are named."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest
from support.runs import unseal

from giveway import run
from giveway.config.files.trust import is_own_folder
from giveway.errors import ResultsError
from giveway.gate import MANIFEST, read_json
from giveway.replays.run_folder import RunFolder
from giveway.run_data.seal import SEAL, faults, require_sealed
from giveway.studies.folder.examination import examine_results

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from support.commands import Typed

SHORT = {"crowd": {"pedestrians": 2}, "time_limit": 0.5}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs of the same scenario, ``one`` and ``other``."""
    folder = tmp_path_factory.mktemp("runs")
    for seed, name in enumerate(("one", "other")):
        speed = {"regulation": {"reference_speed": 4.0 + seed}}
        run(SHORT | speed | {"seed": seed}, results=folder / name, pictures=False)
    return folder


@pytest.fixture
def folder(runs: Path, tmp_path: Path) -> Path:
    """A copy of the run ``one``, to be tampered with, beside one of ``other``."""
    return shutil.copytree(runs, tmp_path / "runs") / "one"


def of_another_run(file: Path) -> None:
    shutil.copy(file.parents[1] / "other" / file.name, file)


def cut(file: Path) -> None:
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:-1]))


def shuffled(file: Path) -> None:
    head, first, *rest = file.read_text().splitlines()
    file.write_text("\n".join([head, *rest, first]) + "\n")


def changed(file: Path) -> None:
    file.write_text(file.read_text().replace("0", "1", 1))


def missing(file: Path) -> None:
    file.unlink()


@pytest.mark.parametrize("harm", [of_another_run, cut, shuffled, changed, missing])
@pytest.mark.parametrize("name", ["ego.csv", "trajectories.csv", "timing.csv", "config.toml"])
def test_a_table_that_is_not_the_runs_is_named(
    folder: Path, name: str, harm: Callable[[Path], None]
) -> None:
    require_sealed(folder, read_json(folder / MANIFEST))
    harm(folder / name)
    (fault,) = faults(folder, read_json(folder / MANIFEST))
    assert fault.file == folder / name
    assert not is_own_folder(folder) or name != "config.toml"
    with pytest.raises(ResultsError, match=rf"{name}: .*--unsealed|'{name}' is missing"):
        RunFolder.read(folder)


def test_a_table_that_was_put_there_is_named(folder: Path) -> None:
    shutil.copy(folder / "ego.csv", folder / "predictions.csv")
    with pytest.raises(ResultsError, match=r"predictions\.csv: was not written by this run"):
        RunFolder.read(folder)


def test_a_manifest_that_was_changed_is_named(folder: Path) -> None:
    manifest = json.loads((folder / MANIFEST).read_text())
    assert is_own_folder(folder)
    (folder / MANIFEST).write_text(json.dumps(manifest | {"time_step": 0.1}))
    with pytest.raises(ResultsError, match=r"manifest\.json: was changed after the run"):
        RunFolder.read(folder)
    assert not is_own_folder(folder)
    (folder / MANIFEST).write_text(json.dumps(manifest | {SEAL: 3}))
    with pytest.raises(ResultsError, match="broken seal"):
        RunFolder.read(folder)


def test_a_name_in_the_seal_reaches_no_other_folder(folder: Path) -> None:
    manifest = json.loads((folder / MANIFEST).read_text())
    manifest[SEAL]["files"]["../other/ego.csv"] = {"bytes": 1, "sha256": ""}
    assert {fault.file.name for fault in faults(folder, manifest)} == {MANIFEST}


def test_the_commands_name_the_table_and_go_on_unsealed(
    folder: Path, type_here: Callable[..., Typed]
) -> None:
    shuffled(folder / "ego.csv")
    line = f"error: {folder / 'ego.csv'}: has another content than the run wrote"
    for words in (["replay", folder], ["export", "run", folder, "--format", "pedpy"]):
        done = type_here(*words)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)
        assert done.stderr.startswith(line)
        assert type_here(*words, "--unsealed").returncode == 0
    (finding,) = examine_results(folder)
    assert finding.level == "error"
    assert "ego.csv: has another content" in finding.text
    assert examine_results(folder.with_name("other"))[0].level == "ok"


def test_a_run_of_an_earlier_giveway_is_played_with_a_note(
    folder: Path, type_here: Callable[..., Typed]
) -> None:
    unseal(folder)
    done = type_here("replay", folder, "--no-rerun")
    assert done.returncode == 0
    assert done.stderr.startswith(f"note: {folder}: has no seal")
