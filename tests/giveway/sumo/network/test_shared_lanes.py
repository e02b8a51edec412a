"""Where a route shares a lane with those who come from another one, as SUMO's network has it.

a === two lanes, 200 m === z --- one lane --- c      both lanes lead on: a zipper
a === two lanes, 200 m === b --- one lane --- c      the right lane ends
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

BOTH = '<connection from="ab" to="bc" fromLane="{0}" toLane="0"/>'


@pytest.fixture(scope="module")
def narrowing(
    tmp_path_factory: pytest.TempPathFactory, call_sumo: Callable[..., str]
) -> Callable[[bool], Path]:
    """A scenario without traffic on two lanes that become one: by a zipper, or as one ends."""

    def build(zipper: bool) -> Path:
        folder = tmp_path_factory.mktemp("narrowing")
        kind = ' type="zipper"' if zipper else ""
        (folder / "n.nod.xml").write_text(
            f'<nodes><node id="a" x="0" y="0"/><node id="b" x="200" y="0"{kind}/>'
            '<node id="c" x="400" y="0"/></nodes>'
        )
        (folder / "e.edg.xml").write_text(
            '<edges><edge id="ab" from="a" to="b" numLanes="2"/>'
            '<edge id="bc" from="b" to="c" numLanes="1"/></edges>'
        )
        lanes = (0, 1) if zipper else (1,)
        text = "".join(map(BOTH.format, lanes))
        (folder / "c.con.xml").write_text(f"<connections>{text}</connections>")
        files = ("-n", "n.nod.xml", "-e", "e.edg.xml", "-x", "c.con.xml", "-o", "net.net.xml")
        call_sumo("netconvert", *files, cwd=folder)
        config = folder / "narrow.sumocfg"
        config.write_text('<configuration><net-file value="net.net.xml"/></configuration>')
        return config

    return build


def test_a_zipper_is_shared_with_the_other_lane(narrowing: Callable[[bool], Path]) -> None:
    config = narrowing(True)
    with SumoSession(read_scenario(config), StartOptions(), "<additional/>") as session:
        lanes = session.lanes
        path = lanes.along(["ab", "bc"], 0)
        (place,) = lanes.mergings(path)
        assert (place.lane, place.origin) == ("bc_0", path.edges[1])
        (before,) = place.over
        assert before == lanes.onwards("ab_1", "bc")[0]
        assert [len(line) for line in place.lines] == [
            len(lanes.shape("ab_1")),
            len(lanes.shape(before)),
        ]
        assert place.begin < place.origin - lanes.length(before)
        assert place.end == place.origin


def test_a_lane_that_ends_makes_a_lane_change(narrowing: Callable[[bool], Path]) -> None:
    config = narrowing(False)
    with SumoSession(read_scenario(config), StartOptions(), "<additional/>") as session:
        path = session.lanes.along(["ab", "bc"], 0, start=50.0)
        (place,) = session.lanes.mergings(path)
        assert (place.lane, place.over, place.origin) == ("ab_1", frozenset(), 0.0)
        assert place.end == path.edges[1]
        assert session.lanes.mergings(session.lanes.along(["ab", "bc"], 1)) == ()
