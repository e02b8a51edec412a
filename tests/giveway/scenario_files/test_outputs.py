"""A run writes nothing beside the scenario, nor where it was started; nothing is lost either."""

from __future__ import annotations

import gzip
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import pytest

from giveway.errors import ResultsError
from giveway.scenario_files import StartOptions, prepare_start, read_scenario
from giveway.scenario_files.options import (
    INPUTS,
    INSTEAD_OF_SIMULATING,
    OUTPUTS,
    SYNONYMS,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

EVERYTHING = """<?xml version="1.0" encoding="UTF-8"?>
<!-- <edgeData id="no" file="comment.xml"/> -->
<additional>
    <include href="more/deep.add.xml"/>
    <include href="more/plain.add.xml"/>
    <e1Detector id="e1" lane="A0A1_1" pos="5" period="10" file="out/det.xml"/>
    <inductionLoop id="il" lane="A0A1_1" pos="6" period="10" file="out/det.xml"/>
    <instantInductionLoop id="ii" lane="A0A1_1" pos="7" file="instant.xml"/>
    <e2Detector id="e2" lane="A0A1_1" pos="10" length="20" period="10" file="e2.csv"/>
    <laneAreaDetector id="la" lane="A0A1_1" pos="12" length="20" period="10" file='la&amp;x.xml'/>
    <e3Detector id="e3" period="10" file="e3.xml.gz">
        <detEntry lane="A0A1_1" pos="5"/><detExit lane="A0A1_1" pos="50"/>
    </e3Detector>
    <entryExitDetector id="ee" period="10" file="NUL">
        <detEntry lane="A0A1_1" pos="5"/><detExit lane="A0A1_1" pos="50"/>
    </entryExitDetector>
    <edgeData id="ed" file="/nowhere/at/all/edges.xml" period="10"/>
    <laneData id="ld" file="b > a.xml" period="10"/>
    <routeProbe id="rp" edge="A0A1" period="10" file="probe.xml"/>
    <vTypeProbe id="vp" type="" period="1" file="vtypes.xml"/>
    <timedEvent type="SaveTLSStates" source="A1" dest="lights.xml"/>
    <calibrator id="cal" edge="A0A1" pos="0" output="calibrated.xml">
        <flow begin="0" end="10" vehsPerHour="300" speed="10" type="DEFAULT_VEHTYPE" route="r"/>
        <route id="r" edges="A0A1"/>
    </calibrator>
    <variableSpeedSign id="vss" lanes="A0A1_1" file="more/vss.xml"/>
    <poly id="p" shape="0,0 1,1 1,0" imgFile="picture.png"/>
</additional>
"""
DEEP = '<additional><edgeData id="deep" file="det.xml" period="10"/></additional>'
SPEEDS = '<vss><step time="0" speed="8"/></vss>'
CAR = """<routes>
    <vType id="watched">
        <param key="has.ssm.device" value="true"/>
        <param key="device.ssm.file" value="out/ssm of type.xml"/>
    </vType>
    <vType id="alone"><param key="has.ssm.device" value="true"/></vType>
    <trip id="car" type="watched" depart="0" from="A0A1" to="C1C2"/>
    <trip id="two" type="alone" depart="2" from="A0A1" to="C1C2"/>
</routes>
"""


@pytest.fixture
def everything(small_scenario: Callable[..., Path]) -> Path:
    """A scenario that writes wherever SUMO lets it."""
    config = small_scenario(
        '<additional-files value="all.add.xml.gz, more/deep.add.xml"/>',
        '<tripinfo v="tripinfo.xml"/><fcd-output value="out/fcd.csv"/>',
        '<summary-output value="sum%20mary.xml.gz"/><statistic-output value="STDOUT"/>',
        '<log value="log.txt"/><error-log value="errors.txt"/>',
        '<save-state.period value="10"/><vtk-output value="vtk/frame"/>',
        '<output-prefix value="run1_"/>',
    )
    folder = config.parent
    (folder / "more").mkdir()
    with gzip.open(folder / "all.add.xml.gz", "wt") as stream:
        stream.write(EVERYTHING)
    (folder / "more" / "deep.add.xml").write_text(DEEP)
    (folder / "more" / "plain.add.xml").write_text("<additional/>")
    (folder / "more" / "vss.xml").write_text(SPEEDS)
    (folder / "car.rou.xml").write_text(CAR)
    return config


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_outputs_of_a_read_only_scenario_go_elsewhere(
    everything: Path, tmp_path: Path, run_started: Callable[..., dict[str, Any]]
) -> None:
    before = tree(everything.parent)
    folders = [path for path in everything.parent.rglob("*") if path.is_dir()]
    for path in (everything.parent, *folders):
        path.chmod(0o555)
    try:
        seen = run_started(everything, until=30, outputs=tmp_path / "out")
    finally:
        for path in (everything.parent, *folders):
            path.chmod(0o755)
    assert tree(everything.parent) == before
    assert tree(tmp_path / "cwd") == {}
    written = tree(tmp_path / "out")
    expected = {
        *("det.xml", "out-det.xml", "instant.xml", "e2.csv", "la&x.xml", "e3.xml.gz", "edges.xml"),
        *("b > a.xml", "probe.xml", "vtypes.xml", "lights.xml", "calibrated.xml", "tripinfo.xml"),
        *("fcd.csv", "sum mary.xml.gz", "log.txt", "errors.txt", "ssm of type.xml", "ssm.xml"),
    }
    states_and_frames = {name for name in written if "state" in name or "frame" in name}
    assert {f"run1_{name}" for name in expected} == set(written) - states_and_frames
    assert any("state" in name for name in states_and_frames)
    assert any("frame" in name for name in states_and_frames)
    assert "<statistics" not in seen["stderr"]


def test_the_copies_behave_as_the_originals(
    everything: Path, tmp_path: Path, run_started: Callable[..., dict[str, Any]]
) -> None:
    seen = run_started(everything, until=30, outputs=tmp_path / "out")
    assert set(seen["copies"].values()) == {
        str(everything.parent / name)
        for name in ("all.add.xml.gz", "car.rou.xml", "more/deep.add.xml")
    }
    detectors = ET.parse(tmp_path / "out" / "run1_out-det.xml").getroot()
    assert {interval.get("id") for interval in detectors} == {"e1", "il"}
    deep = ET.parse(tmp_path / "out" / "run1_det.xml").getroot()
    assert {interval.get("id") for interval in deep} == {"deep"}


def test_without_a_results_folder_everything_is_dropped_and_said(
    everything: Path, tmp_path: Path, run_started: Callable[..., dict[str, Any]]
) -> None:
    before = tree(everything.parent)
    seen = run_started(everything, until=5)
    assert tree(everything.parent) == before
    assert tree(tmp_path / "cwd") == {}
    assert any("are dropped; name a results folder" in remark for remark in seen["remarks"])


def test_files_that_write_nothing_are_used_where_they_are(
    small_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    config = small_scenario('<additional-files value="stops.add.xml"/>')
    stops = config.with_name("stops.add.xml")
    stops.write_text(
        '<additional><include href="none.xml"/><edgeData id="e" file="NUL"/></additional>'
    )
    start = prepare_start(read_scenario(config), StartOptions(), tmp_path)
    assert start.command[4].split(",")[1:] == [str(stops)]
    assert not start.copies
    assert set(start.read) == {path for _, path in read_scenario(config).inputs}
    assert not start.outputs
    (remark,) = start.remarks
    assert remark.startswith(f"{stops}: names none.xml, which is not in")


def test_a_prefix_with_a_folder_does_not_lead_out(
    small_scenario: Callable[..., Path], tmp_path: Path, run_started: Callable[..., dict[str, Any]]
) -> None:
    config = small_scenario(
        '<tripinfo-output value="t.xml"/><output-prefix value="../elsewhere/a_"/>'
    )
    seen = run_started(config, until=2, outputs=tmp_path / "out")
    assert set(tree(tmp_path / "out")) == {"a_t.xml"}
    assert any("'../elsewhere/a_'" in remark for remark in seen["remarks"])


def test_the_users_outputs_are_added_and_the_scenarios_kept(
    small_scenario: Callable[..., Path], tmp_path: Path, run_started: Callable[..., dict[str, Any]]
) -> None:
    config = small_scenario('<fcd-output value="own.xml"/>')
    wanted = ("fcd", "tripinfo", "summary", "ssm")
    extra = ["--tripinfo-output.write-unfinished", "--statistic-output=s.xml", "--scale", "1"]
    run_started(config, until=10, outputs=tmp_path / "out", extra=extra, written=wanted)
    names = {"own.xml", "tripinfo.xml", "summary.xml", "ssm.xml", "s.xml"}
    assert set(tree(tmp_path / "out")) == names


def test_sumo_takes_a_colon_for_a_network_address(
    small_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    scenario = read_scenario(small_scenario('<fcd-output value="own.xml"/>'))
    with pytest.raises(ResultsError, match="12:30: SUMO takes the ':' for a network address"):
        prepare_start(scenario, StartOptions(outputs=tmp_path / "12:30"), tmp_path)


def test_the_tables_of_options_are_those_of_sumo(
    tmp_path: Path, call_sumo: Callable[..., str]
) -> None:
    call_sumo("sumo", "--save-template", "template.xml", cwd=tmp_path)
    options = [
        option for section in ET.parse(tmp_path / "template.xml").getroot() for option in section
    ]
    files = {option.tag for option in options if option.get("type") == "FILE"}
    by_string = {"device.ssm.file", "device.toc.file"}
    folders = {"phemlight-path", "configuration-file"}
    of_the_window = {
        "gui-settings-file",
        "edgedata-files",
        "alternative-net-file",
        "selection-file",
        "gui-testing.setting-output",
    }
    ours = {*OUTPUTS, *INPUTS, *of_the_window, *INSTEAD_OF_SIMULATING}
    assert ours == (files | by_string) - folders
    synonyms = {
        synonym: option.tag for option in options for synonym in option.get("synonymes", "").split()
    }
    assert SYNONYMS.items() <= synonyms.items()
    of_files = {name: option for name, option in synonyms.items() if option in ours}
    assert of_files.items() <= SYNONYMS.items()
