"""The doctor names what is wrong, with its remedy, and leaves everything as it was."""

from __future__ import annotations

import gzip
import shlex
import signal
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest

from giveway.cli.commands.doctor_command import doctor_command
from giveway.doctor import Finding, examine_environment, examine_scenario
from giveway.doctor.trial import judged, try_in_sumo

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def about(findings: list[Finding], subject: str) -> Finding:
    (found,) = [finding for finding in findings if finding.subject == subject]
    return found


def errors(findings: list[Finding]) -> list[Finding]:
    return [finding for finding in findings if finding.level == "error"]


def test_this_environment_is_sound(tmp_path: Path) -> None:
    findings = examine_environment(tmp_path)
    assert errors(findings) == []
    subjects = {finding.subject for finding in findings}
    assert {"Python", "SUMO", "OSQP", "numba", "vehicle, FMI 2.0", "libsumo"} <= subjects
    assert "1.28" in about(findings, "SUMO").text


def test_a_results_folder_below_a_file_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    finding = about(examine_environment(tmp_path / "file" / "results"), "results folder")
    assert finding.level == "error"
    assert "--out" in finding.remedy


@pytest.fixture(scope="module")
def of_city(small_city: Path) -> list[Finding]:
    before = sorted(small_city.parent.iterdir())
    findings = examine_scenario(small_city)
    assert sorted(small_city.parent.iterdir()) == before
    return findings


def test_a_city_is_fit_to_drive_in(of_city: list[Finding]) -> None:
    assert {finding.level for finding in of_city} <= {"ok", "note"}
    assert "crossings" in about(of_city, "walkways").text
    assert about(of_city, "demand").text.startswith("30 vehicles and 0 flows, 60 persons")
    assert about(of_city, "traffic lights").text == "16 programs"
    assert about(of_city, "step length").text == "0.5 s, 10 control step(s) of 0.05 s"
    assert about(of_city, "time").text == "from 10 s to 80 s"


def test_it_names_vehicles_to_take_and_edges_to_drive(of_city: list[Finding]) -> None:
    ego = about(of_city, "ego")
    assert "cars" in ego.text
    assert ego.remedy.startswith("--ego=cars")
    assert "--ego-route=" in ego.remedy


def test_it_ranks_egos_routes_and_zones_by_the_people_they_meet(
    of_city: list[Finding], small_city: Path
) -> None:
    assert "counted from 10 to 80 s" in about(of_city, "people met").text
    for subject, flag in (
        ("best egos", "--ego=cars"),
        ("best routes", "--ego-route="),
        ("best zones", "--zone="),
    ):
        ranked = [finding for finding in of_city if finding.subject == subject]
        assert 1 <= len(ranked) <= 3
        for finding in ranked:
            words = shlex.split(finding.remedy)
            assert words[:3] == ["giveway", "run", str(small_city)]
            assert any(word.startswith(flag) for word in words)
    best = [finding for finding in of_city if finding.subject == "best egos"]
    people = [int(finding.text.split(" meets ")[1].partition(",")[0]) for finding in best]
    assert people == sorted(people, reverse=True)
    assert people[-1] > 0


def test_its_command_runs_and_the_ego_meets_people(
    of_city: list[Finding], type_here: Callable[..., Any], tmp_path: Path
) -> None:
    best = next(finding for finding in of_city if finding.subject == "best egos")
    words = shlex.split(best.remedy)[1:]
    out = ("--no-pictures", "--out", tmp_path / "out", "--time-limit", 15)
    done = type_here(*words, *out, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "pedestrians.csv").read_text().count("\n") > 1


def test_a_scenario_without_people_gets_a_place_for_some(
    small_scenario: Callable[..., Path],
) -> None:
    finding = about(examine_scenario(small_scenario()), "spawn area")
    assert "the way of car" in finding.text
    words = shlex.split(finding.remedy)
    assert words[3:6] == ["--ego=car", "--pedestrians", "20"]
    assert [word.partition("=")[0] for word in words[6:]] == ["--spawn-area", "--walk"]


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


def test_a_sumo_that_does_not_answer_is_given_up(small_city: Path) -> None:
    (finding,) = try_in_sumo(small_city, patience=0.01)
    assert finding.level == "error"
    assert "still busy after 0.01 s" in finding.text


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="other systems have no signals")
def test_a_sumo_that_crashes_is_a_finding(small_city: Path) -> None:
    crash = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    result = subprocess.run(
        [sys.executable, "-c", crash], check=False, capture_output=True, text=True
    )
    (finding,) = judged(small_city, result)
    assert finding.text == "SUMO crashed (SIGSEGV)"


def test_the_command_prints_tables_and_its_exit_code_tells(
    small_scenario: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    config = small_scenario()
    assert doctor_command(str(config)) == 0
    shown = capsys.readouterr().out
    assert "Environment" in shown
    assert "--ego=car" in shown
    config.with_name("car.rou.xml").unlink()
    assert doctor_command(str(config)) == 1
    shown = capsys.readouterr().out
    assert "-> put it there, or correct it" in shown
    assert "1 error: a run will not work before that is put right." in shown


def test_with_drawn_traffic_the_commands_ask_for_the_trials_one() -> None:
    findings = examine_scenario("junction")
    ranked = [f for f in findings if f.subject in {"best egos", "best routes", "best zones"}]
    assert len(ranked) > 5
    assert all("--sumo-seed=scenario" in finding.remedy for finding in ranked)


def test_where_they_do_not_the_commands_say_nothing_of_seeds(of_city: list[Finding]) -> None:
    assert not any("--sumo-seed" in finding.remedy for finding in of_city)
