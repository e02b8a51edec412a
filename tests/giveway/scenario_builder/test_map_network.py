"""A map's marked crossings give people priority; what is no map is refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from giveway.errors import ScenarioError
from giveway.scenario_builder.map_network import network_sources, read_map

MAP = Path(__file__).parents[3] / "docs" / "tutorials" / "helsinki.osm"


def priorities(text: str) -> list[str]:
    return re.findall(r'<crossing [^>]*priority="(.)"', text)


def test_people_have_priority_where_the_map_marks_a_crossing(tmp_path: Path) -> None:
    """Two of 28 crossings have traffic lights; nobody marked three of the others."""
    sources, warnings = network_sources(MAP, "city", tmp_path)
    assert sorted(sources) == [f"city.{kind}.xml" for kind in ("con", "edg", "nod", "tll", "typ")]
    assert sorted(priorities(sources["city.con.xml"])) == ["0"] * 3 + ["1"] * 25
    assert warnings == 4
    assert not any("generated on" in text for text in sources.values())


def test_without_marks_people_wait_for_a_gap(tmp_path: Path) -> None:
    unmarked = tmp_path / "unmarked.osm"
    unmarked.write_text(MAP.read_text("utf-8").replace('v="uncontrolled"', 'v="unmarked"'))
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    sources, _ = network_sources(unmarked, "city", scratch)
    assert sorted(priorities(sources["city.con.xml"])) == ["0"] * 26 + ["1"] * 2


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("map.pbf", b"\x00", "osmium cat"),
        ("map.osm", b"\x00\x01", "is not XML"),
        ("map.osm", b"<net/>", "begins with <net>; expected <osm>"),
        ("map.osm.gz", b"\x1f\x8b\x00", "cannot be read"),
    ],
)
def test_what_is_no_map_is_refused(tmp_path: Path, name: str, content: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ScenarioError, match=message):
        read_map(tmp_path / name)


def test_a_map_without_streets_is_refused(tmp_path: Path) -> None:
    empty = tmp_path / "empty.osm"
    empty.write_text("<osm></osm>")
    with pytest.raises(ScenarioError, match=r"empty\.osm: netconvert makes no network of it"):
        network_sources(empty, "empty", tmp_path)


def test_a_map_without_streets_for_cars_is_refused(tmp_path: Path) -> None:
    raceways = tmp_path / "raceways.osm"
    text = re.sub(
        r'k="highway" v="(residential|secondary|service)"',
        r'k="highway" v="raceway"',
        MAP.read_text("utf-8"),
    )
    raceways.write_text(text)
    refusal = r"raceways\.osm: (no streets for cars|.* No edges loaded)"
    with pytest.raises(ScenarioError, match=refusal):
        network_sources(raceways, "raceways", tmp_path)
