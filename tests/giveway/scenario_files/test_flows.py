"""Which flows may let a vehicle depart in a step, and where, before SUMO itself knows of it."""

from pathlib import Path

import pytest

from giveway.scenario_files import FlowStart, flows_due


def due(tmp_path: Path, text: str, until: float, step: float = 1.0) -> list[FlowStart]:
    file = tmp_path / "r.rou.xml"
    file.write_text(f"<routes>{text}</routes>")
    return flows_due([file], until - step, until, 0.0)


@pytest.mark.parametrize(
    ("timing", "departures"),
    [
        ('begin="0" period="3"', {0, 3, 6, 9, 12}),
        ('begin="4" end="10" period="3"', {4, 7, 10}),
        ('begin="0:0:4" vehsPerHour="1200" end="100"', {4, 7, 10}),
        ('begin="2" end="14" number="3"', {2, 6, 10}),
        ('begin="2" number="2" period="5"', {2, 7}),
        ('period="5"', {0, 5, 10}),
        ('begin="5" end="8" probability="0.1"', {5, 6, 7, 8}),
        ('begin="8" period="exp(0.2)"', {8, 9, 10, 11, 12}),
        ('begin="triggered"', set(range(13))),
    ],
)
def test_a_flow_is_due_in_the_steps_of_sumos_departures(
    tmp_path: Path, timing: str, departures: set[int]
) -> None:
    flow = f'<flow id="f" from="ab" to="cd" {timing}/>'
    assert {t for t in range(13) if due(tmp_path, flow, t)} == departures


def test_a_departure_between_two_steps_is_due_in_the_second(tmp_path: Path) -> None:
    flow = '<flow id="f" from="ab" to="cd" begin="0.25" period="1"/>'
    assert [t for t in (0.0, 0.5, 1.0, 1.5) if due(tmp_path, flow, t, 0.5)] == [0.5, 1.5]


@pytest.mark.parametrize(
    ("flow", "start"),
    [
        ('<flow id="f" from="ab" to="cd" period="1"/>', FlowStart("ab", "")),
        ("<flow id='f' route='r&amp;1' period='1'/>", FlowStart("", "r&1")),
        ('<flow id="f" period="1">\n<!-- x --> <route edges="ab cd"/></flow>', FlowStart("ab", "")),
        ('<flow id="f" fromTaz="1" period="1"/><route id="r" edges="x"/>', FlowStart("", "")),
    ],
)
def test_it_says_where_a_flow_begins(tmp_path: Path, flow: str, start: FlowStart) -> None:
    assert due(tmp_path, flow, 5.0) == [start]


def test_a_file_that_cannot_be_read_is_left_to_sumo(tmp_path: Path) -> None:
    assert flows_due([tmp_path / "none.rou.xml"], 0.0, 1.0, 0.0) == []
