"""Scenarios on a grid of streets without sidewalks."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import sumo

if TYPE_CHECKING:
    from collections.abc import Callable

    Scenario = Callable[..., str]


EASTWARDS = ["A0B0", "B0C0"]


ROUTE = '<route edges="A0B0 B0C0"/>'


NOBODY = {"crowd": {"zone": "none"}}


@pytest.fixture(scope="session")
def streets(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a grid of three by three junctions."""
    folder = tmp_path_factory.mktemp("streets")
    home = Path(sumo.SUMO_HOME)
    command = [home / "bin" / "netgenerate", "--grid", "--grid.number", "3"]
    command += ["--grid.length", "100", "--default.lanenumber", "2", "-o", "net.net.xml"]
    environment = os.environ | {"SUMO_HOME": str(home)}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    return folder


@pytest.fixture
def street_scenario(streets: Path, tmp_path: Path) -> Scenario:
    """Write a scenario of these routes; its path."""

    def write(routes: str, *, step: float = 1.0, end: float = 120.0) -> str:
        config = tmp_path / "streets.sumocfg"
        (tmp_path / "routes.rou.xml").write_text(f"<routes>{routes}</routes>")
        config.write_text(
            f"""<configuration>
            <net-file value="{streets / "net.net.xml"}"/>
            <route-files value="routes.rou.xml"/>
            <end value="{end}"/> <step-length value="{step}"/>
            </configuration>"""
        )
        return str(config)

    return write
