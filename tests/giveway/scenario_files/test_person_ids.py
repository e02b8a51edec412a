"""Added pedestrians are called ped0, ped1, ... unless the scenario has such names itself."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING

from giveway.scenario_files import free_prefix

if TYPE_CHECKING:
    from pathlib import Path


def test_a_scenarios_own_names_are_left_to_it(tmp_path: Path) -> None:
    plain, packed = tmp_path / "a.rou.xml", tmp_path / "b.rou.xml.gz"
    plain.write_text("<routes><person depart='7'\n id='walker'><walk/></person></routes>")
    packed.write_bytes(gzip.compress(b'<routes><personFlow id="ped" begin="0"/></routes>'))
    assert free_prefix("ped", [plain]) == "ped"
    assert free_prefix("ped", [plain, packed]) == "added_ped"
    plain.write_text('<person id="added_ped3"/>')
    assert free_prefix("ped", [plain, packed]) == "added_added_ped"


def test_vehicles_may_have_them(tmp_path: Path) -> None:
    routes = tmp_path / "a.rou.xml"
    routes.write_text('<trip id="ped0"/><walk/><person id="a pedestrian"/><stop id="ped"/>')
    assert free_prefix("ped", [routes]) == "ped"


def test_an_unreadable_file_is_sumos_business(tmp_path: Path) -> None:
    assert free_prefix("ped", [tmp_path / "missing.rou.xml"]) == "ped"
