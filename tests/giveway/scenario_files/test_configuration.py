"""A .sumocfg is read as SUMO reads it, and what is wrong with it is said in one line."""

from __future__ import annotations

import gzip
import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.errors import ScenarioError
from giveway.scenario_files import read_scenario
from giveway.scenario_files.configuration import seconds
from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture
def config(tmp_path: Path) -> Callable[[str], Path]:
    """A .sumocfg with the given content."""

    def write(content: str) -> Path:
        file = tmp_path / "some where" / "a.sumocfg"
        file.parent.mkdir(exist_ok=True)
        file.write_text(content)
        return file

    return write


def test_sections_flat_options_short_names_and_text_are_equal(
    config: Callable[[str], Path],
) -> None:
    by_section = """<configuration>
        <input><net-file value="n.net.xml"/><route-files value="a.xml, b.xml"/>
        <additional-files value="c.xml"/></input>
        <time><begin value="15:00:00"/><end value="16:0:0"/><step-length value=".1"/></time>
        <random_number><seed value="4"/></random_number></configuration>"""
    by_name = """<c><n v="n.net.xml"/><routes v="a.xml,b.xml"/><a v="c.xml"/>
        <b v="54000"/><e value="57600.0"/><step-length>0.1</step-length><srand v="4"/></c>"""
    first = read_scenario(config(by_section))
    second = read_scenario(config(by_name))
    folder = first.config_file.parent
    assert first.net_file == folder / "n.net.xml"
    assert first.route_files == (folder / "a.xml", folder / "b.xml")
    assert first.additional_files == (folder / "c.xml",)
    assert (first.begin, first.end, first.step_length, first.seed) == (54000, 57600, 0.1, 4)
    for name in ("net_file", "route_files", "additional_files", "begin", "end", "step_length"):
        assert getattr(first, name) == getattr(second, name)


def test_what_is_not_set_is_sumos_default(config: Callable[[str], Path]) -> None:
    scenario = read_scenario(config('<c><net-file value="n.xml"/></c>'))
    assert (scenario.begin, scenario.end, scenario.step_length) == (0.0, None, 1.0)
    assert (scenario.seed, scenario.random, scenario.pedestrian_model) == (None, False, "striping")
    assert scenario.outputs == {}


def test_names_may_hold_spaces_escapes_variables_and_a_home(
    config: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("CITY", "delft")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("NOBODY", raising=False)
    lines = '<n v="${CITY}${NOBODY}.net.xml"/><r v="a b.xml,../c%20d.xml"/><a v="~/e.xml"/>'
    scenario = read_scenario(config(f"<c>{lines}</c>"))
    folder = scenario.config_file.parent
    assert scenario.net_file == folder / "delft.net.xml"
    assert scenario.route_files == (folder / "a b.xml", folder.parent / "c d.xml")
    assert scenario.additional_files == (tmp_path / "e.xml",)


def test_sumo_finds_the_files_that_we_find(
    small_scenario: Callable[..., Path],
    run_started: Callable[..., dict[str, Any]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NAME_OF_FILE", "my own")
    file = small_scenario('<additional-files value="${NAME_OF_FILE}.add.xml, s%20t.add.xml"/>')
    for name in ("my own", "s t"):
        file.with_name(f"{name}.add.xml").write_text("<additional/>")
    assert read_scenario(file).missing == ()
    seen = run_started(file, until=2, interact=False)
    assert "my own.add.xml" in seen["command"][seen["command"].index("--additional-files") + 1]


def test_the_outputs_are_named(config: Callable[[str], Path]) -> None:
    lines = '<n v="n"/><tripinfo v="t.xml"/><save-state.files v="a.xml,b.xml"/>'
    scenario = read_scenario(config(f'<c>{lines}<device.ssm.file v="s, t"/></c>'))
    assert scenario.outputs == {
        "tripinfo-output": ("t.xml",),
        "save-state.files": ("a.xml", "b.xml"),
        "device.ssm.file": ("s, t",),
    }


def test_the_inputs_are_all_that_a_run_is_made_of(config: Callable[[str], Path]) -> None:
    lines = '<n v="n.xml"/><r v="a.xml"/><w v="w.xml"/><load-state v="s.xml.gz"/><g v="g.xml"/>'
    scenario = read_scenario(config(f"<c>{lines}</c>"))
    found = [(option, path.name) for option, path in scenario.inputs]
    assert found == [
        ("net-file", "n.xml"),
        ("route-files", "a.xml"),
        ("weight-files", "w.xml"),
        ("load-state", "s.xml.gz"),
    ]
    assert scenario.missing == scenario.inputs


@pytest.mark.parametrize("name", ["shared_space", "street"])
def test_the_bundled_scenarios_are_complete(name: str) -> None:
    scenario = read_scenario(find(name).config_file)
    assert scenario.inputs
    scenario.require_inputs()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "a.sumocfg: the file is empty; expected a SUMO configuration (.sumocfg)"),
        ("net: n.xml", "a.sumocfg: not XML (syntax error: line 1, column 0); expected a SUMO"),
        ("<c><n v='x'></c>", "a.sumocfg: not XML (mismatched tag"),
        ("<c/>", "a.sumocfg: net-file = ''; expected one road network; add <net-file"),
        ('<c><n v="a,b"/></c>', "a.sumocfg: net-file = 'a,b'; expected one road network"),
        ('<c><n v="a"/><net v="b"/></c>', "net-file = 'b' stands there a second time (first 'a')"),
        ('<c><n v="a"/><b v="soon"/></c>', "begin = 'soon'; expected seconds, h:m:s or d:h:m:s"),
        ('<c><n v="a"/><e v="1:30"/></c>', "end = '1:30'; expected seconds, h:m:s or d:h:m:s"),
        ('<c><n v="a"/><step-length v="1e308"/></c>', "step-length = '1e308'; expected seconds"),
        ('<c><n v="a"/><end v="1e308:0:0"/></c>', "end = '1e308:0:0'; expected seconds"),
        ('<c><n v="a"/><step-length v="0"/></c>', "step-length = 0; expected more than 0 s"),
        ('<c><n v="a"/><b v="nan"/></c>', "begin = 'nan'; expected seconds"),
        ('<c><n v="a"/><seed v="1.5"/></c>', "seed = '1.5'; expected a whole number"),
        ('<c><n v="a"/><random v="si"/></c>', "random = 'si'; expected true or false"),
        (
            '<c><n v="a"/><C v="out.sumocfg"/></c>',
            "save-configuration = 'out.sumocfg' makes SUMO write that file instead of simulating",
        ),
    ],
)
def test_a_broken_configuration_is_said_in_one_line(
    content: str, message: str, config: Callable[[str], Path]
) -> None:
    with pytest.raises(ScenarioError, match=re.escape(message)) as caught:
        read_scenario(config(content))
    assert "\n" not in str(caught.value)


def test_a_missing_configuration(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"none\.sumocfg: no such file; expected a SUMO"):
        read_scenario(tmp_path / "none.sumocfg")
    with pytest.raises(ScenarioError, match=r"cannot be read \(.*directory"):
        read_scenario(tmp_path)


def test_a_compressed_configuration_is_refused_as_by_sumo(tmp_path: Path) -> None:
    file = tmp_path / "a.sumocfg"
    file.write_bytes(gzip.compress(b'<c><n v="a"/></c>'))
    with pytest.raises(ScenarioError, match="not XML"):
        read_scenario(file)


@pytest.mark.parametrize("option", ["route-files", "additional-files", "weight-files"])
def test_a_missing_file_is_named_with_its_option(
    option: str, small_scenario: Callable[..., Path]
) -> None:
    if option == "route-files":
        file = small_scenario()
        file.with_name("car.rou.xml").unlink()
    else:
        file = small_scenario(f'<{option} value="none.xml"/>')
    with pytest.raises(ScenarioError, match=rf"small\.sumocfg: {option} names .*does not exist"):
        read_scenario(file).require_inputs()


def test_a_comma_in_a_folders_name_is_the_end_of_a_name_to_sumo(
    small_scenario: Callable[..., Path],
) -> None:
    with pytest.raises(ScenarioError, match=r"one, two/net\.net\.xml\.gz; SUMO takes the ','"):
        read_scenario(small_scenario(folder="one, two")).require_inputs()


def test_a_missing_network_and_a_folder_for_a_file(small_scenario: Callable[..., Path]) -> None:
    file = small_scenario('<additional-files value="."/>')
    with pytest.raises(ScenarioError, match="additional-files names the folder"):
        read_scenario(file).require_inputs()
    file.with_name("net.net.xml.gz").unlink()
    with pytest.raises(ScenarioError, match=r"net-file names .*net\.net\.xml\.gz, which does not"):
        read_scenario(file).require_inputs()


@given(st.integers(0, 9), st.integers(0, 23), st.integers(0, 59), st.integers(0, 59_999))
def test_times_are_counted_in_seconds(days: int, hours: int, minutes: int, millis: int) -> None:
    rest = millis / 1000
    total = ((days * 24 + hours) * 60 + minutes) * 60 + rest
    assert seconds(f"{days}:{hours:02}:{minutes:02}:{rest:.3f}") == pytest.approx(total)
    assert seconds(f"{24 * days + hours}:{minutes}:{rest}") == pytest.approx(total)
    assert seconds(str(total)) == total


def test_a_name_longer_than_any_files_is_a_missing_file(config: Callable[[str], Path]) -> None:
    scenario = read_scenario(config(f'<c><n v="{"n" * 3000}"/></c>'))
    with pytest.raises(ScenarioError, match=r"net-file names .*nnn, which does not exist"):
        scenario.require_inputs()
