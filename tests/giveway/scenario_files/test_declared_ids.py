"""Whether a scenario's files declare a vehicle."""

import gzip
from typing import TYPE_CHECKING

from giveway.scenario_files import free_prefix

if TYPE_CHECKING:
    from pathlib import Path

from pathlib import Path

import pytest

from giveway.scenario_files import declares, undeclared

ROUTES = b"""<routes>
  <vType id="car"/>
  <vehicle id="veh12" depart="0"><route edges="a b"/></vehicle>
  <trip depart="1" id='t "1"' from="a" to="b"/>
  <flow id="north" begin="0" end="9" number="3" from="a" to="b"/>
  <flow id="a&amp;b" begin="0" end="9" number="3" from="a" to="b"/>
  <person id="p7" depart="0"/>
</routes>"""


@pytest.fixture(params=["plain", "gzip"])
def routes(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    file = tmp_path / "routes.xml"
    file.write_bytes(gzip.compress(ROUTES) if request.param == "gzip" else ROUTES)
    return file


@pytest.mark.parametrize("name", ["veh12", 't "1"', "north.0", "north.27", "a&b.1"])
def test_declared_vehicles_are_found(routes: Path, name: str) -> None:
    assert undeclared(name, [routes]) is None


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("veh13", "did you mean 'veh12'"),
        ("north", "did you mean 'north.0'"),
        ("north.x", "did you mean 'north.0'"),
        ("zzz", "name one like veh12"),
        ("p7", "name one like"),
        ("car", "name one like"),
    ],
)
def test_others_are_not_and_the_likely_one_is_named(routes: Path, name: str, hint: str) -> None:
    assert hint in str(undeclared(name, [routes]))


def test_a_declaration_may_lie_across_two_chunks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "routes.xml"
    file.write_bytes(ROUTES)
    for size in (1, 7, 64):
        monkeypatch.setattr("giveway.scenario_files.reading._CHUNK", size)
        assert undeclared("north.1", [file]) is None
        assert undeclared("zzz", [file]) is not None


def test_a_calibrator_may_bring_any_vehicle(tmp_path: Path) -> None:
    file = tmp_path / "more.add.xml"
    file.write_bytes(b'<additional><calibrator id="c" edge="a" pos="0"/></additional>')
    assert undeclared("c.4", [file]) is None


def test_a_scenario_without_vehicles_says_so(tmp_path: Path) -> None:
    file = tmp_path / "routes.xml"
    file.write_bytes(b"<routes/>")
    assert "--ego-route" in str(undeclared("x", [file]))


def test_what_is_declared_for_sure(routes: Path, tmp_path: Path) -> None:
    assert declares("veh12", [routes])
    assert declares("north.2", [routes])
    assert not declares("ego", [routes])
    assert not declares("north", [routes])
    calibrated = tmp_path / "more.add.xml"
    calibrated.write_bytes(b'<additional><calibrator id="c" edge="a" pos="0"/></additional>')
    assert not declares("c.0", [calibrated])


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
