"""Tables that are written in pieces: the same bytes, and three forms of the longest one."""

from __future__ import annotations

import gzip
import json
from typing import TYPE_CHECKING

import pandas as pd
import pytest

from giveway.api import run_checked
from giveway.config.files.loading import as_layer, load
from giveway.cosimulation.preflight import preflight
from giveway.journal import stored_crowd, stored_rows
from giveway.replays.run_folder import RunFolder
from giveway.results.folder import Destination
from giveway.run_data.tracks import CrowdTrack

if TYPE_CHECKING:
    from pathlib import Path

CONFIG = {
    "scenario": "crossings",
    "controller": "pid-tuned",
    "crowd": {"zone": "everywhere"},
    "time_limit": 4.0,
}


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """One run at once, as CSV, and one in pieces of some steps, as .csv.gz and Parquet."""
    place, found = tmp_path_factory.mktemp("forms"), {}
    with pytest.MonkeyPatch.context() as small:
        for form in ("csv", "csv.gz"):
            (place / f"{form}-journal").mkdir()
            found[form] = place / form
            packed = form != "csv"
            files = Destination(found[form], False, packed, form, False)  # type: ignore[arg-type]
            checked = preflight(*load([as_layer(CONFIG)]))
            result = run_checked(checked, files, journal=place / f"{form}-journal")
            assert (type(result.crowd_track) is CrowdTrack) == (form == "csv")
            small.setattr(stored_rows, "LONG", 200)
            small.setattr(stored_rows, "PIECE", 150)
            small.setattr(stored_crowd, "_PART", 160)
    return found


def test_pieces_have_the_same_bytes(folders: dict[str, Path]) -> None:
    whole, pieces = folders["csv"], folders["csv.gz"]
    for file in whole.glob("*.csv"):
        if file.stem not in {"timing", "trajectories"}:
            assert (pieces / file.name).read_bytes() == file.read_bytes(), file.name
    packed = gzip.decompress((pieces / "trajectories.csv.gz").read_bytes())
    assert packed == (whole / "trajectories.csv").read_bytes()
    assert (pieces / "scene.json").read_bytes() == (whole / "scene.json").read_bytes()


def test_parquet_rounds_to_the_same_decimals(folders: dict[str, Path]) -> None:
    csv = pd.read_csv(folders["csv"] / "trajectories.csv", dtype={"id": str})
    parquet = pd.read_parquet(folders["csv.gz"] / "trajectories.parquet")
    rounded = parquet.round(6)
    for name in csv:
        if csv[name].dtype == float:
            assert (rounded[name] + 0.0 == csv[name]).all(), name
        else:
            assert parquet[name].tolist() == csv[name].tolist()


def test_each_form_is_read_and_described(folders: dict[str, Path]) -> None:
    rows = len(RunFolder.read(folders["csv"]).trajectories)
    for form, folder in folders.items():
        assert len(RunFolder.read(folder).trajectories) == rows > 300
        package = json.loads((folder / "datapackage.json").read_text())
        paths = {resource["name"]: resource["path"] for resource in package["resources"]}
        assert paths["trajectories"] == f"trajectories.{form}"
    assert not (folders["csv.gz"] / "trajectories.csv").exists()
    (folders["csv.gz"] / "trajectories.csv.gz").unlink()
    assert len(RunFolder.read(folders["csv.gz"], unsealed=True).trajectories) == rows


def test_a_long_crowd_has_a_remark_on_its_picture(folders: dict[str, Path]) -> None:
    said = [(folder / "manifest.json").read_text() for folder in folders.values()]
    assert ["too many for a picture from above" in text for text in said] == [False, True]
