"""Who lets whom go first, as a network file says it."""

import gzip
from pathlib import Path

import pytest

from giveway.errors import ScenarioError
from giveway.scenario_files.right_of_way import right_of_way, stop_offsets

NET = """<net>
    <junction id="centre" incLanes="west_0 south_0" intLanes=":c_0_0 :c_4_0 :c_c0_0">
        <request index="0" response="000" foes="110" cont="0"/>
        <request index="1" response="101" foes="101" cont="1"/>
        <request index="2" response="011" foes="011" cont="0"/>
    </junction>
    <junction id="end" type="dead_end" incLanes="east_0" intLanes=""/>
    <junction id=":c_4_0" type="internal" incLanes=":c_1_0" intLanes=":c_0_0"/>
</net>"""


def test_bits_are_numbers_of_links_counted_from_the_right(tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(NET)
    (junction,) = right_of_way(tmp_path / "a.net.xml").items()
    name, logic = junction
    assert name == "centre"
    assert logic.incoming == ("west_0", "south_0")
    assert logic.inside == (":c_0_0", ":c_4_0", ":c_c0_0")
    assert [sorted(request.yields_to) for request in logic.requests] == [[], [0, 2], [0, 1]]
    assert [sorted(request.meets) for request in logic.requests] == [[1, 2], [0, 2], [0, 1]]


def test_a_zipped_network_says_the_same(tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(NET)
    (tmp_path / "a.net.xml.gz").write_bytes(gzip.compress(NET.encode()))
    assert right_of_way(tmp_path / "a.net.xml.gz") == right_of_way(tmp_path / "a.net.xml")


def test_a_network_that_changes_is_read_again(tmp_path: Path) -> None:
    net = tmp_path / "a.net.xml"
    net.write_text(NET)
    assert "centre" in right_of_way(net)
    net.write_text(NET.replace("centre", "crossroads"))
    assert list(right_of_way(net)) == ["crossroads"]


def test_what_is_no_row_of_bits_is_named_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(NET.replace('response="101"', 'response="1x1"'))
    with pytest.raises(ScenarioError, match=r"a\.net\.xml: line 4: '1x1' is not a row of bits"):
        right_of_way(tmp_path / "a.net.xml")


def test_a_junction_with_more_requests_than_links_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(NET.replace(" :c_4_0 :c_c0_0", ""))
    assert right_of_way(tmp_path / "a.net.xml") == {}


def test_stop_lines_before_the_end_of_their_lane(tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(
        """<net>
        <edge id="ab"><stopOffset value="6.00" exceptions="bicycle moped"/>
            <lane id="ab_0"/><lane id="ab_1"><stopOffset value="2" vClasses="bus"/></lane></edge>
        <edge id="bc"><lane id="bc_0"><stopOffset value="3.5"/></lane></edge></net>"""
    )
    found = stop_offsets(tmp_path / "a.net.xml")
    assert {name: offset.value for name, offset in found.items()} == {
        "ab": 6.0,
        "ab_1": 2.0,
        "bc_0": 3.5,
    }
    kinds = ("passenger", "bicycle", "bus")
    assert [found["ab"].holds_for(kind) for kind in kinds] == [True, False, True]
    assert [found["ab_1"].holds_for(kind) for kind in kinds] == [False, False, True]
    assert [found["bc_0"].holds_for(kind) for kind in kinds] == [True, True, True]


@pytest.mark.parametrize("value", ["-1", "nan", "far"])
def test_a_stop_line_at_no_distance_is_refused(tmp_path: Path, value: str) -> None:
    net = tmp_path / "a.net.xml"
    net.write_text(f'<net><edge id="ab"><stopOffset value="{value}"/></edge></net>')
    with pytest.raises(ScenarioError, match=r"a\.net\.xml: line 1: .*" + value):
        stop_offsets(net)
