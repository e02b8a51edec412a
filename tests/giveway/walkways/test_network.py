"""The network of walkways: what it has, and what is refused."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from giveway.errors import ScenarioError
from giveway.walkways import WalkNetwork
from tests.giveway.walkways.conftest import EDGES

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


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
    np.testing.assert_array_equal(zipped.wall_segments, plain.network.wall_segments)


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
    assert network.wall_segments.shape == (0, 4)
    assert network.boundary == (0.0, 0.0, 0.0, 0.0)
