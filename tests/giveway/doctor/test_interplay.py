"""The doctor names what acts on people or egos, with the remedy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.doctor.interplay import interplay
from giveway.scenario_files import read_scenario

if TYPE_CHECKING:
    from pathlib import Path

NET = """<net>
    <tlLogic id="asks" type="actuated" programID="0"/><tlLogic id="fixed" type="static"/>
    <tlLogic id="cars only" type="actuated"/>
    <connection from=":a_w0" to=":a_c0" tl="asks" linkIndex="2" state="M"/>
    <connection from=":b_w0" to=":b_c0" tl="fixed" linkIndex="2" state="M"/>
    <connection from=":c_w0" to=":c_c12" state="m"/><connection from=":d_w0" to=":d_c0" state="M"/>
    <connection from="x" to="y" tl="cars only" linkIndex="0" state="o"/></net>"""
DEMAND = """<routes>
    <vType id="cab" vClass="taxi"><param key="has.taxi.device" value="true"/></vType>
    <vType id="no cab"><param key="has.taxi.device" value="false"/></vType>
    <vehicle id="bus" depart="0"><stop lane="x_0" triggered="person"/></vehicle>
    <vehicle id="coach" depart="0"><stop lane="x_0" triggered="false"/></vehicle></routes>"""
MORE = """<additional>
    <inductionLoop id="loop" detectPersons="walk"/><entryExitDetector id="e3" detectPersons="walk"/>
    <rerouter id="closed" edges="x y"><interval><closingReroute id="y"/></interval></rerouter>
    </additional>"""


def scenario(folder: Path, net: str, demand: str, more: str) -> Path:
    for name, text in (("n.net.xml", net), ("r.rou.xml", demand), ("a.add.xml", more)):
        (folder / name).write_text(text)
    config = folder / "s.sumocfg"
    config.write_text(
        """<configuration><net-file value="n.net.xml"/><route-files value="r.rou.xml"/>
        <additional-files value="a.add.xml"/><end value="10"/></configuration>"""
    )
    return config


def test_everything_is_named_once_and_by_its_id(tmp_path: Path) -> None:
    findings = interplay(read_scenario(scenario(tmp_path, NET, DEMAND, MORE)))
    names = {finding.subject: finding.text.partition(":")[0] for finding in findings}
    assert names == {
        "lights on request": "asks",
        "gap crossings": "",  # SUMO's ids of crossings begin with a colon
        "buses": "bus",
        "taxis": "cab",
        "detectors": "loop",
        "blind detectors": "e3",
        "rerouter": "closed on x, y",
    }
    assert all(finding.remedy for finding in findings)
    (gap,) = (finding for finding in findings if finding.subject == "gap crossings")
    assert gap.text.startswith(":c_c12: ")


def test_a_plain_scenario_has_nothing_to_name(tmp_path: Path) -> None:
    plain = scenario(tmp_path, "<net/>", "<routes/>", "<additional/>")
    assert interplay(read_scenario(plain)) == []


def test_many_names_are_counted(tmp_path: Path) -> None:
    taxi = '<vType id="{}"><param key="has.taxi.device" value="1"/></vType>'
    types = "".join(taxi.format(name) for name in "edcba")
    files = read_scenario(scenario(tmp_path, "<net/>", f"<routes>{types}</routes>", "<a/>"))
    (taxis,) = interplay(files)
    assert taxis.text.startswith("a, b, c and 2 more: ")
