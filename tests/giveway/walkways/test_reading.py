"""Network files are read as SUMO reads them; what is no network is refused in one line."""

from __future__ import annotations

import gzip
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from giveway.errors import ScenarioError
from giveway.walkways import WalkNetwork
from giveway.walkways.reading import survey

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

EDGES = """<net>
    <location convBoundary="0.00,0.00,100.00,50.00"/>
    <edge id=":J" function="internal"><lane id=":J_0" length="1" shape="0,0 1,0"/></edge>
    <edge id="road" from="a" to="b">
        <lane id="road_0" index="0" disallow="pedestrian" length="50" width="3" shape="0,0 50,0"/>
        <lane id="road_1" index="1" allow="pedestrian bicycle" length="50" shape="0,3 50,3"/>
        <lane id="road_2" index="2" allow="pedestrian" length="60" width="2" shape="0,6,1 50,6,1"/>
    </edge>
    <edge id="motorway" from="a" to="b">
        <lane id="motorway_0" index="0" allow="passenger" length="50" shape="0,20 50,20"/>
    </edge>
    <edge id="lane" from="a" to="b">
        <lane id="lane_0" index="0" length="50" shape="0,30 50,30"/>
    </edge>
</net>"""


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str | bytes], Path]:
    def write(content: str | bytes) -> Path:
        file = tmp_path / "town.net.xml"
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        return file

    return write


def test_people_walk_on_the_lane_that_is_theirs_alone(written: Callable[..., Path]) -> None:
    lane = survey(written(EDGES)).edges["road"].lane
    assert (lane.id, lane.width, lane.length) == ("road_2", 2.0, 60.0)
    np.testing.assert_array_equal(lane.shape, [[0.0, 6.0], [50.0, 6.0]])


def test_else_on_the_first_usable_lane_as_wide_as_sumo_says(
    written: Callable[..., Path],
) -> None:
    lane = survey(written(EDGES)).edges["lane"].lane
    assert (lane.id, lane.width) == ("lane_0", 3.2)


@pytest.mark.parametrize("edge", ["motorway", ":J", "nowhere"])
def test_where_nobody_may_walk_there_is_no_lane(written: Callable[..., Path], edge: str) -> None:
    assert edge not in survey(written(EDGES)).edges


def test_what_a_network_has(built: Callable[[str], Any], written: Callable[..., Path]) -> None:
    grid, bare = built("grid").network, built("bare").network
    assert grid.has_walkingareas
    assert grid.has_sidewalks
    assert not bare.has_walkingareas
    assert not bare.has_sidewalks
    assert bare.signals == ()
    assert bare.boundary == (0.0, 0.0, 240.0, 240.0)
    assert WalkNetwork.read(written(EDGES)).boundary == (0.0, 0.0, 100.0, 50.0)


def test_without_a_location_the_boundary_is_that_of_the_lanes(written: Callable[..., Path]) -> None:
    network = WalkNetwork.read(written(EDGES.replace("<location", "<elsewhere")))
    assert network.boundary == (0.0, 6.0, 50.0, 30.0)


def test_gzip_is_seen_by_content(built: Callable[[str], Any], written: Callable[..., Path]) -> None:
    plain = built("grid")
    zipped = WalkNetwork.read(written(gzip.compress(plain.file.read_bytes())))
    assert zipped.signals == plain.network.signals
    np.testing.assert_array_equal(zipped.wall_segments(), plain.network.wall_segments())


def test_signals_are_the_links_that_sumo_controls(
    built: Callable[[str], Any], sumo_walks: Callable[[str], Any]
) -> None:
    signals = built("grid").network.signals
    links = sumo_walks("grid")["links"]
    ours = {(signal.tls, signal.link): f"{signal.crossing}_0" for signal in signals}
    assert len(ours) == len(signals) == 20
    theirs = {
        (tls, i): place
        for tls, controlled in links.items()
        for i, places in enumerate(controlled)
        for place in itertools.chain(*places)
        if "_c" in place
    }
    assert ours == theirs


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ("", "not XML"),
        ("no xml", "not XML"),
        ("<net><edge", "not XML"),
        ("<routes/>", "no <net> in it"),
        (b"\x1f\x8bxxxxxxxxxxxxxxxx", "cannot be read|damaged"),
        (gzip.compress(EDGES.encode())[:-40], "damaged"),
        (EDGES.replace('length="50" shape="0,30', 'length="long" shape="0,30'), "line 13.*'long'"),
        (EDGES.replace("0,30 50,30", "0,30 50,north"), "line 13.*'north'"),
        (EDGES.replace("0,30 50,30", "0,30 50,nan"), "line 13.*not finite"),
        (EDGES.replace("0,30 50,30", "0,30"), "line 13.*1 point"),
        (EDGES.replace('id="lane" from="a"', 'id="lane"'), "line 13.*'from' is missing"),
    ],
)
def test_what_is_no_network_is_refused_in_one_line(
    written: Callable[..., Path], content: str | bytes, complaint: str
) -> None:
    file = written(content)
    with pytest.raises(ScenarioError, match=complaint) as caught:
        WalkNetwork.read(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="No such file"):
        WalkNetwork.read(tmp_path / "nowhere.net.xml")


def test_the_nearest_lane_counts_in_sumos_metres(written: Callable[..., Path]) -> None:
    network = WalkNetwork.read(written(EDGES))
    nearest = network.nearest_lane(25.0, 8.0)
    assert nearest == ("road", "road_2", pytest.approx(30.0), pytest.approx(2.0))
    beyond = network.nearest_lane(54.0, 33.0)
    assert beyond == ("lane", "lane_0", pytest.approx(50.0), pytest.approx(5.0))


def test_no_lane_is_near_where_there_is_none(written: Callable[..., Path]) -> None:
    network = WalkNetwork.read(written("<net/>"))
    assert network.nearest_lane(0.0, 0.0) is None
    assert network.wall_segments().shape == (0, 4)
    assert network.boundary == (0.0, 0.0, 0.0, 0.0)
