from __future__ import annotations

import json
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from sumo_scenarios import Scenario, find

if TYPE_CHECKING:
    from collections.abc import Callable

PROBES = Path(__file__).parents[1] / "support" / "programs" / "scenario_probes.py"


@pytest.fixture
def probe(tmp_path: Path, run_program: Callable[..., Any]) -> Callable[..., dict[str, Any]]:
    """Run one look of scenario_probes.py, in a process and a working folder of its own."""

    def run(
        name: str, config: Path, step_length: float | None = None, **arguments: Any
    ) -> dict[str, Any]:
        request = {"config": str(config), "step_length": step_length} | arguments
        result = run_program(PROBES, name, json.dumps(request), cwd=tmp_path)
        assert result.returncode == 0, f"exit code {result.returncode}: {result.stderr}"
        seen: dict[str, Any] = json.loads(result.stdout)
        return seen

    return run


@pytest.fixture(params=["crossings", "junction", "shared_space", "street"])
def scenario(request: pytest.FixtureRequest) -> Scenario:
    return find(request.param)


@pytest.fixture(params=["shared_space", "street"])
def open_road(request: pytest.FixtureRequest) -> Scenario:
    """A scenario whose ego drives along one edge, which nothing holds up."""
    return find(request.param)


@pytest.fixture
def settings() -> Callable[[Scenario], dict[str, Any]]:
    """The giveway settings of a scenario, as they stand in its file."""

    def read(scenario: Scenario) -> dict[str, Any]:
        assert scenario.settings_file is not None
        return tomllib.loads(scenario.settings_file.read_text(encoding="utf-8"))

    return read


@pytest.fixture
def xml_of() -> Callable[[str, str], ElementTree.Element]:
    """One of a bundled scenario's files, by the scenario's name and the file's last part."""

    def read(name: str, suffix: str) -> ElementTree.Element:
        return ElementTree.parse(find(name).folder / f"{name}.{suffix}").getroot()

    return read
