"""The rerouters that may send any vehicle another way."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.scenario_files.rerouters import Rerouter, rerouters

if TYPE_CHECKING:
    from pathlib import Path


def test_rerouters_of_parking_areas_and_those_switched_off_are_left_out(tmp_path: Path) -> None:
    file = tmp_path / "r.add.xml"
    parking = '<interval><parkingAreaReroute id="p"/></interval>'
    closing = '<interval><closingReroute id="ab"/></interval>'
    file.write_text(
        f'<additional><rerouter id="park" edges="ab">{parking}</rerouter>'
        f'<rerouter id="off" off="true" edges="ab">{closing}</rerouter>'
        f'<rerouter id="closed" edges="ab bc">{closing}</rerouter></additional>'
    )
    assert rerouters([file, tmp_path / "none.xml"]) == [Rerouter("closed", ("ab", "bc"))]
