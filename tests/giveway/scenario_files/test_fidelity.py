"""Nothing moved, nothing added: SUMO's simulation is the scenario's own to the last byte."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest

from sumo_scenarios import find

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_HEADER = re.compile(rb"<!-- generated on .*?-->", re.DOTALL)


def content(file: Path) -> bytes:
    """An output without its header, which holds the date and the command."""
    text, headers = _HEADER.subn(b"", file.read_bytes(), count=1)
    assert headers == 1
    return text


@pytest.fixture
def same_fcd(
    tmp_path: Path, call_sumo: Callable[..., str], run_started: Callable[..., dict[str, Any]]
) -> Callable[..., bytes]:
    """Make sure that giveway's start and plain SUMO write the same FCD; hand it over."""

    def compare(config: Path, until: float, *plain: str, **options: Any) -> bytes:
        fcd = tmp_path / "plain.xml"
        call_sumo(
            *("sumo", "-c", config, "--fcd-output", fcd, "--end", until, "--no-step-log", *plain),
            cwd=tmp_path,
        )
        out = tmp_path / "out"
        run_started(config, until=until, interact=False, written=("fcd",), outputs=out, **options)
        ours, theirs = content(out / "fcd.xml"), content(fcd)
        assert ours == theirs
        return ours

    return compare


def test_the_demonstration_that_comes_with_sumo(
    sumo_home: Path, same_fcd: Callable[..., bytes]
) -> None:
    config = sumo_home / "tools" / "game" / "fokr_bs_demo.sumocfg"
    fcd = same_fcd(config, 15 * 3600 + 150)
    assert b'<timestep time="54000.00"' in fcd
    assert fcd.count(b"<vehicle ") > 1000
    assert fcd.count(b"<person ") > 100


def test_a_city_of_cars_and_persons(small_city: Path, same_fcd: Callable[..., bytes]) -> None:
    fcd = same_fcd(small_city, 80)
    assert fcd.count(b"<vehicle ") > 1000
    assert fcd.count(b"<person ") > 1000


def test_the_seed_is_the_one_that_plain_sumo_would_take(
    small_city: Path, same_fcd: Callable[..., bytes]
) -> None:
    assert same_fcd(small_city, 40, "--seed", "7", seed=7) != same_fcd(small_city, 40)


WRITING = """<additional>
    <edgeData id="e" file="edges.xml" period="10"/>
    <instantInductionLoop id="i" lane="A0A1_1" pos="7" file="more/loops.xml"/>
    <include href="more/slow.add.xml"/>
</additional>"""
SLOW = """<additional>
    <variableSpeedSign id="v" lanes="A0A1_1" file="steps.xml"/>
    <laneData id="l" file="lanes.xml"/>
</additional>"""


def test_a_scenario_run_from_copies_because_it_writes(
    small_scenario: Callable[..., Path], same_fcd: Callable[..., bytes], tmp_path: Path
) -> None:
    config = small_scenario('<additional-files value="w.add.xml"/><tripinfo-output value="t.xml"/>')
    more = config.parent / "more"
    more.mkdir()
    config.with_name("w.add.xml").write_text(WRITING)
    (more / "slow.add.xml").write_text(SLOW)
    (more / "steps.xml").write_text('<vss><step time="0" speed="3"/></vss>')
    same_fcd(config, 60)
    for name in ("edges.xml", "t.xml", "more/loops.xml", "more/lanes.xml"):
        file = config.parent / name  # plain SUMO wrote it there
        assert content(tmp_path / "out" / file.name) == content(file)


@pytest.mark.parametrize("name", ["shared_space", "street"])
def test_the_bundled_scenarios(name: str, same_fcd: Callable[..., bytes]) -> None:
    same_fcd(find(name).config_file, 60)


def test_with_nothing_moved_the_scenarios_pedestrian_model_stays(
    small_scenario: Callable[..., Path], run_started: Callable[..., dict[str, Any]]
) -> None:
    config = small_scenario(
        '<pedestrian.model value="nonInteracting"/><collision.action value="remove"/>'
    )
    seen = run_started(config, until=5, interact=False)
    assert "--pedestrian.model" not in seen["command"]
    assert "--collision.action" not in seen["command"]
    assert seen["remarks"] == []
