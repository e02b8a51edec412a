"""The doctor counts polygons by type: those that hide people from cameras, and the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.doctor import examine_scenario

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

POLYGONS = """<additional>
    <poly id="a" type="building.house" shape="0,10 4,10 4,12 0,10"/>
    <poly id="b" type="building.house" shape="9,10 14,10 14,12 9,10"/>
    <poly id="c" type="wall" shape="1,1 9,1"/>
    <poly id="d" type="landuse.park" shape="5,5 6,5 6,6"/>
    <poly id="e" shape="5,5 6,5 6,6"/>
</additional>
"""


def told(scenario: Path) -> list[tuple[str, str, str]]:
    findings = [one for one in examine_scenario(scenario) if one.subject == "opaque polygons"]
    return [(one.level, one.text, one.remedy) for one in findings]


def test_polygons_are_counted_by_type_and_by_what_they_hide(
    small_scenario: Callable[..., Path],
) -> None:
    config = small_scenario('<additional-files value="polygons.add.xml"/>')
    config.with_name("polygons.add.xml").write_text(POLYGONS, encoding="utf-8")
    opaque, left = told(config)
    assert opaque[:2] == (
        "ok",
        "2 building.house (10 m), 1 wall (2 m); a polygon's own height comes before it",
    )
    assert left[:2] == ("note", "hide nobody: 1 landuse.park, 1 without a type")
    assert left[2].startswith('to take one: --perception-opaque "building 10, wall 2, hedge 1.5,')
    settings = config.with_name(config.stem + ".giveway.toml")
    settings.write_text('[perception]\nopaque = "landuse 3"\n', encoding="utf-8")
    assert told(config)[0][1].startswith("1 landuse.park (3 m)")


def test_a_scenario_without_polygons_has_no_such_finding(
    small_scenario: Callable[..., Path],
) -> None:
    assert told(small_scenario()) == []


def test_cameras_that_nothing_hides_anybody_from_are_noted(
    small_scenario: Callable[..., Path],
) -> None:
    config = small_scenario()
    config.with_name("car.rou.xml").write_text("<routes/>", encoding="utf-8")
    settings = config.with_name(config.stem + ".giveway.toml")
    settings.write_text('[perception]\nsensor = "sight"\n', encoding="utf-8")
    ((level, text, _),) = told(config)
    assert level == "note"
    assert text.startswith("sensor 'sight': nothing hides anybody: no polygon")
