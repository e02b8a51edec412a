"""The results folder: its files, their schema, and their bytes."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

import giveway
from giveway.errors import ResultsError
from giveway.results.folder import FILES, taken_folder, write_results

CONFIG = {"seed": 4, "crowd": {"pedestrians": 8}}
DETERMINISTIC = ("ego.csv", "trajectories.csv", "pedestrians.csv", "summary.csv", "config.toml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results") / "first"
    giveway.run(CONFIG, results=folder, parquet=True)
    return folder


def test_all_files_are_there_and_none_else(folder: Path) -> None:
    names = {path.name for path in folder.iterdir()}
    assert names <= FILES
    assert {"ego.csv", "state.png", "top_view.png", "manifest.json", "summary.json"} <= names
    assert all(path.stat().st_size for path in folder.iterdir())


def test_the_data_package_describes_every_column(folder: Path) -> None:
    package = json.loads((folder / "datapackage.json").read_text())
    for resource in package["resources"]:
        table = pd.read_csv(folder / resource["path"])
        fields = resource["schema"]["fields"]
        assert [field["name"] for field in fields] == list(table.columns)
        for field in fields:
            assert field["description"]
            values = table[field["name"]].dropna()
            if field["type"] == "number" and len(values):
                assert pd.api.types.is_numeric_dtype(values), field
            if field["type"] == "integer" and len(values):
                assert (values == values.astype(int)).all(), field


def test_trajectories_keep_sumos_fcd_names(folder: Path) -> None:
    table = pd.read_csv(folder / "trajectories.csv")
    names = ["time", "id", "type", "x", "y", "angle", "speed", "vx", "vy"]
    assert list(table.columns) == names
    assert table["time"].is_monotonic_increasing
    assert not table.duplicated(["time", "id"]).any()
    assert table["angle"].between(0, 360, inclusive="left").all()
    ego = table[table["type"] == "ego"]
    assert (ego["angle"] == 90).all()


def test_parquet_holds_the_same_tables(folder: Path) -> None:
    for name in ("ego", "trajectories", "pedestrians"):
        from_csv = pd.read_csv(folder / f"{name}.csv")
        from_parquet = pd.read_parquet(folder / f"{name}.parquet")
        assert list(from_csv.columns) == list(from_parquet.columns)
        assert len(from_csv) == len(from_parquet)


def test_the_manifest_names_what_the_run_was_made_of(folder: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["ending"] == "completed"
    assert manifest["seed"] == 4
    assert len(manifest["vehicles"]["ego"]["sha256"]) == 64
    assert {"shared_space.net.xml", "shared_space.sumocfg"} <= set(manifest["scenario"]["sha256"])
    assert {"giveway", "libsumo", "fmpy", "osqp", "numpy"} <= set(manifest["software"])
    assert manifest["processor"]["name"]
    assert manifest["processor"]["blas"]


def test_the_same_seed_gives_the_same_bytes_in_one_process(folder: Path, tmp_path: Path) -> None:
    giveway.run({"seed": 99, "crowd": {"pedestrians": 5}})  # whatever came before is forgotten
    giveway.run(CONFIG, results=tmp_path / "again", pictures=False)
    for name in DETERMINISTIC:
        assert (tmp_path / "again" / name).read_bytes() == (folder / name).read_bytes(), name


def test_the_manifests_command_gives_equal_bytes_elsewhere(folder: Path, tmp_path: Path) -> None:
    command = json.loads((folder / "manifest.json").read_text())["reproduce"]
    arguments = command.replace("ANOTHER_FOLDER", str(tmp_path / "again")).split()[1:]
    subprocess.run(
        [sys.executable, "-m", "giveway", *arguments], cwd=folder, check=True, capture_output=True
    )
    for name in DETERMINISTIC:
        assert (tmp_path / "again" / name).read_bytes() == (folder / name).read_bytes(), name


def test_existing_results_are_kept_unless_forced(folder: Path) -> None:
    before = (folder / "ego.csv").read_bytes()
    with pytest.raises(ResultsError, match="force=True"):
        giveway.run(CONFIG | {"seed": 5}, results=folder)
    assert (folder / "ego.csv").read_bytes() == before


def test_python_is_told_its_own_words(folder: Path) -> None:
    with pytest.raises(ResultsError, match="with force=True or name another with out="):
        giveway.run(CONFIG, results=folder)


def test_force_replaces_and_never_mixes(tmp_path: Path) -> None:
    giveway.run(CONFIG, results=tmp_path / "r", parquet=True)
    giveway.run(CONFIG, results=tmp_path / "r", force=True, pictures=False)
    names = {path.name for path in (tmp_path / "r").iterdir()}
    assert "ego.parquet" not in names
    assert "state.png" not in names


def test_a_folder_with_somebody_elses_files_is_never_emptied(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(ResultsError, match=r"thesis\.tex"):
        giveway.run(CONFIG, results=tmp_path, force=True)
    assert (tmp_path / "thesis.tex").exists()


@pytest.mark.skipif(os.name == "nt", reason="POSIX device files")
def test_an_unwritable_place_is_refused_before_the_run() -> None:
    with pytest.raises(ResultsError, match="out="):
        giveway.run(CONFIG, results="/proc/giveway")


@pytest.mark.skipif(os.name == "nt", reason="POSIX resource limits")
def test_a_disk_that_takes_no_more_is_said_in_one_line(tmp_path: Path) -> None:
    import resource

    result = giveway.run(CONFIG)
    _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        with pytest.raises(ResultsError, match=r"cannot be written \(File too large\)"):
            write_results(result, tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, hard))


def test_a_forced_run_that_cannot_begin_keeps_the_former_results(tmp_path: Path) -> None:
    giveway.run(CONFIG, results=tmp_path / "r", pictures=False)
    before = (tmp_path / "r" / "ego.csv").read_bytes()
    with pytest.raises(giveway.GivewayError, match=r"nope\.fmu"):
        giveway.run(CONFIG | {"vehicle": {"fmu": "nope.fmu"}}, results=tmp_path / "r", force=True)
    assert (tmp_path / "r" / "ego.csv").read_bytes() == before


def test_a_run_that_cannot_begin_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(giveway.GivewayError):
        giveway.run(CONFIG | {"vehicle": {"fmu": "nope.fmu"}}, results=tmp_path / "r")
    assert not (tmp_path / "r").exists()


def test_a_folder_that_another_run_has_taken_is_refused(tmp_path: Path) -> None:
    with taken_folder(tmp_path / "r", force=False) as empty:
        assert empty
        for force in (False, True):
            with (
                pytest.raises(ResultsError, match=r"another run is writing there.*--out"),
                taken_folder(tmp_path / "r", force=force),
            ):
                pass
