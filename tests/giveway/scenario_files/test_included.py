"""Which further files a scenario's files refer to."""

import gzip

import pytest

from giveway.results.inputs import scenario_hashes
from giveway.scenario_files import with_included
from sumo_scenarios import find

EMPTY = "<additional/>"


@pytest.fixture
def folder(tmp_path):
    """more.add.xml includes a file in a folder beside it, which includes the first again."""
    (tmp_path / "in").mkdir()
    more = """<additional>
        <include href = 'in/cars.add.xml'/> <rerouter id="r" edges="e" file="reroute.xml"/>
        <include href="absent.xml"/> <poly id="p" file="no_reference.xml"/>
    </additional>"""
    (tmp_path / "more.add.xml").write_text(more)
    back = '<additional><include href="../more.add.xml"/></additional>'
    (tmp_path / "in" / "cars.add.xml").write_bytes(gzip.compress(back.encode()))
    for name in ("reroute.xml", "no_reference.xml"):
        (tmp_path / name).write_text(EMPTY)
    return tmp_path


def test_each_is_found_once_from_the_file_that_names_it(folder):
    found = with_included([folder / "more.add.xml"])
    names = ["more.add.xml", "cars.add.xml", "reroute.xml"]
    assert [file.name for file in found] == names


def test_what_cannot_be_read_refers_to_nothing(tmp_path):
    cut = gzip.compress(b"<additional>" + b" " * 1000)[:-12]
    (tmp_path / "cut.add.xml").write_bytes(cut)
    assert with_included([tmp_path / "cut.add.xml"]) == [tmp_path / "cut.add.xml"]


def test_an_included_file_is_part_of_what_a_run_depends_on(folder):
    (folder / "n.net.xml").write_text("<net/>")
    config = folder / "a.sumocfg"
    config.write_text(
        '<configuration><input><net-file value="n.net.xml"/>'
        '<additional-files value="more.add.xml"/></input></configuration>'
    )
    before = scenario_hashes(find(str(config)))
    (folder / "reroute.xml").write_text("<additional> </additional>")
    after = scenario_hashes(find(str(config)))
    assert {name for name in after if after[name] != before[name]} == {"reroute.xml"}
    assert "in/cars.add.xml" in after
