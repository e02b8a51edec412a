"""The doctor names what is wrong, with its remedy, and leaves everything as it was."""

from __future__ import annotations

import gzip
import shlex
from typing import TYPE_CHECKING

import pytest

import giveway
from giveway.doctor import Finding, examine_scenario

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def about(findings: list[Finding], subject: str) -> Finding:
    (found,) = [finding for finding in findings if finding.subject == subject]
    return found


def errors(findings: list[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.level == "error"]


def test_a_scenario_without_people_gets_a_place_for_some(
    small_scenario: Callable[..., Path],
) -> None:
    finding = about(examine_scenario(small_scenario()), "spawn area")
    assert "the way of car" in finding.text
    words = shlex.split(finding.remedy)
    assert words[3:6] == ["--ego=car", "--pedestrians", "20"]
    assert [word.partition("=")[0] for word in words[6:]] == ["--spawn-area", "--walk"]


def test_a_scenario_without_vehicles_gets_a_route_that_can_be_driven(
    small_scenario: Callable[..., Path],
) -> None:
    config = small_scenario()
    (config.parent / "car.rou.xml").write_text("<routes/>")
    findings = examine_scenario(config)
    finding = about(findings, "ego")
    assert finding.level == "warning"
    *run, flag = shlex.split(finding.remedy)
    assert run == ["giveway", "run", str(config)]
    route = flag.removeprefix("--ego-route=")
    place = about(findings, "spawn area")
    assert "the way of this route" in place.text
    assert flag in place.remedy
    settings = {"scenario": str(config), "time_limit": 0.2, "ego.route": route.split(",")}
    assert len(giveway.run(settings, pictures=False).time) == 5


@pytest.mark.parametrize(("step", "level"), [("1", "note"), ("0.5", "ok"), ("0.1", "ok")])
def test_steps_in_which_cars_look_only_once_are_noted(
    small_scenario: Callable[..., Path], step: str, level: str
) -> None:
    finding = about(
        examine_scenario(small_scenario(f'<step-length value="{step}"/>')), "step length"
    )
    assert finding.level == level
    assert ("--sumo-step-length 0.1" in finding.remedy) == (level == "note")


def test_what_a_run_would_change_is_noted(small_scenario: Callable[..., Path]) -> None:
    config = small_scenario(
        '<pedestrian.model value="nonInteracting"/><random value="true"/>',
        '<collision.action value="teleport"/><time-to-teleport value="77"/>',
        '<lateral-resolution value="0.8"/><step-length value="0.12"/>',
        '<tripinfo-output value="t.xml"/>',
    )
    findings = examine_scenario(config)
    assert errors(findings) == []
    assert about(findings, "pedestrian model").level == "warning"
    assert "--seed" in about(findings, "seed").remedy
    assert "instead of the scenario's teleport" in about(findings, "collision.action").text
    assert "time-to-teleport 77" in about(findings, "teleporting").text
    assert about(findings, "lanes").text == "sublane model, 0.8 m"
    assert about(findings, "step length").text == "0.12 s, 3 control step(s) of 0.04 s"
    assert "with no end" in about(findings, "time").text
    assert "t.xml: written into RESULTS/sumo" in about(findings, "outputs").text


def test_what_sumo_cannot_read_but_does_without_is_a_warning(
    small_scenario: Callable[..., Path],
) -> None:
    config = small_scenario()
    config.with_name("car.rou.xml").write_text('<routes><include href="none.xml"/></routes>')
    finding = about(examine_scenario(config), "SUMO's errors")
    assert finding.level == "warning"
    assert "none.xml" in finding.text


def test_without_walkways_only_persons_of_the_scenario_suffer(
    small_scenario: Callable[..., Path], call_sumo: Callable[..., str]
) -> None:
    config = small_scenario()
    call_sumo(
        "netgenerate", "--grid", "--grid.number", 3, "-o", "net.net.xml.gz", cwd=config.parent
    )
    assert about(examine_scenario(config), "walkways").level == "note"
    routes = config.with_name("car.rou.xml")
    walker = '<person id="p" depart="0"><walk edges="A0A1"/></person></routes>'
    routes.write_text(routes.read_text().replace("</routes>", walker))
    assert about(examine_scenario(config), "walkways").level == "warning"


def test_walkingareas_are_no_sidewalks(
    small_scenario: Callable[..., Path], call_sumo: Callable[..., str]
) -> None:
    config = small_scenario()
    grid = ("netgenerate", "--grid", "--grid.number", 3, "--default.spreadtype", "center")
    call_sumo(*grid, "--walkingareas", "-o", "net.net.xml.gz", cwd=config.parent)
    assert "no sidewalks" in about(examine_scenario(config), "walkways").text


def test_an_old_network_and_one_with_traffic_on_the_left(
    small_scenario: Callable[..., Path],
) -> None:
    config = small_scenario()
    net = config.with_name("net.net.xml.gz")
    text = gzip.decompress(net.read_bytes()).decode()
    net.write_text(text.replace('<net version="1.20"', '<net lefthand="true" version="0.13"'))
    findings = [finding for finding in examine_scenario(config) if finding.subject == "network"]
    assert [finding.level for finding in findings] == ["ok", "warning", "note"]
    assert "netconvert -s" in findings[1].remedy
    assert findings[2].text == "left-hand traffic"


@pytest.mark.parametrize(
    ("file", "content", "message"),
    [
        ("small.sumocfg", "", "the file is empty"),
        ("car.rou.xml", None, "route-files names"),
        ("net.net.xml.gz", None, "net-file names"),
        ("net.net.xml.gz", "<routes/>", "is not a road network"),
        ("car.rou.xml", "<routes><trip", "SUMO refuses the scenario"),
        ("car.rou.xml", '<routes><trip id="a" depart="0" from="X" to="C1C2"/></routes>', "'X'"),
    ],
)
def test_what_is_broken_is_an_error_with_a_remedy(
    file: str, content: str | None, message: str, small_scenario: Callable[..., Path]
) -> None:
    config = small_scenario()
    if content is None:
        config.with_name(file).unlink()
    else:
        config.with_name(file).write_text(content)
    found = errors(examine_scenario(config))
    assert any(message in finding.text for finding in found), found
    assert all(finding.remedy and "\n" not in finding.text for finding in found)


def test_a_truncated_file_is_an_error(small_scenario: Callable[..., Path]) -> None:
    config = small_scenario()
    net = config.with_name("net.net.xml.gz")
    net.write_bytes(net.read_bytes()[:-100])
    assert any("cannot be read" in finding.text for finding in errors(examine_scenario(config)))


def test_an_unknown_scenario_is_an_error() -> None:
    (finding,) = examine_scenario("stret")
    assert finding.level == "error"
    assert "did you mean 'street'?" in finding.text


def test_references_to_the_web_are_named(small_scenario: Callable[..., Path]) -> None:
    config = small_scenario('<additional-files value="web.add.xml"/>')
    picture = '<poly id="p" shape="0,0 1,1 1,0" imgFile="https://example.org/map.png"/>'
    config.with_name("web.add.xml").write_text(f"<additional>{picture}</additional>")
    finding = about(examine_scenario(config), "remote files")
    assert finding.level == "warning"
    assert finding.text.startswith("https://example.org/map.png; nothing is fetched")


def test_with_drawn_traffic_the_commands_ask_for_the_trials_one() -> None:
    findings = examine_scenario("junction")
    ranked = [f for f in findings if f.subject in {"best egos", "best routes", "best zones"}]
    assert len(ranked) > 5
    assert all("--sumo-seed=scenario" in finding.remedy for finding in ranked)
