"""A run at a junction that lies somewhere on earth."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

import giveway
from giveway.replays.run_folder import RunFolder
from sumo_scenarios import find

SOMEWHERE = 'netOffset="-690634.03,-5335533.48" convBoundary="{}" origBoundary="{}" '
SOMEWHERE += 'projParameter="+proj=utm +zone=32 +ellps=WGS84 +datum=WGS84 +units=m +no_defs"'


@pytest.fixture(scope="session")
def on_earth(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a run through a copy of the bundled junction with a projection."""
    folder = tmp_path_factory.mktemp("exports")
    scenario = folder / "junction"
    shutil.copytree(find("junction").config_file.parent, scenario)
    (net,) = scenario.glob("*.net.xml")
    text, count = re.subn(
        r'netOffset="[^"]*" convBoundary="([^"]*)" origBoundary="([^"]*)" projParameter="[^"]*"',
        lambda found: SOMEWHERE.format(*found.groups()),
        net.read_text(encoding="utf-8"),
    )
    assert count == 1
    net.write_text(text, encoding="utf-8")
    settings = {"scenario": str(scenario), "seed": 2, "time_limit": 10.0}
    giveway.run(settings, results=folder / "run", pictures=False)
    return folder / "run"


@pytest.fixture(scope="session")
def run(on_earth: Path) -> RunFolder:
    """The same, read."""
    return RunFolder.read(on_earth)
