"""Networks that SUMO loads and no run can use: one line says what is wrong."""

from pathlib import Path

import numpy as np
import pytest

from giveway.errors import ScenarioError
from giveway.scenario_files import StartOptions, read_scenario
from giveway.scenario_files.path_network import network_along
from giveway.sumo.session import SumoSession

UNSOUND = {
    "long": r"has lane 'drive_0', 2e\+05 m long; expected at most 100000 m; .* write it again",
    "far": r"network is 6e\+06 m wide; expected at most 5e\+06 m",
    "wide": r"has lane 'drive_0', 3.2e\+03 m wide; expected at most 50 m",
    "other names": "lane 'mine' of edge 'drive': expected the name 'drive_INDEX'",
}


def network(kind: str) -> str:
    length = {"long": 2e5, "far": 6e6}.get(kind, 100.0)
    text = network_along(np.array([[0.0, 0.0], [length, 0.0]]), 10.0)
    if kind == "wide":
        return text.replace('width="3.20"', 'width="3200"')
    return text.replace('"drive_0"', '"mine"') if kind == "other names" else text


@pytest.mark.parametrize("kind", [*UNSOUND, "sound"])
def test_what_no_run_can_use_is_refused_in_one_line(tmp_path: Path, kind: str) -> None:
    (tmp_path / "n.net.xml").write_text(network(kind), encoding="utf-8")
    config = tmp_path / "n.sumocfg"
    config.write_text('<configuration><net-file value="n.net.xml"/></configuration>')
    files = read_scenario(config)
    if kind == "sound":
        SumoSession(files, StartOptions(), "<additional/>").close()
        return
    with pytest.raises(ScenarioError, match=UNSOUND[kind]) as caught:
        SumoSession(files, StartOptions(), "<additional/>")
    assert str(caught.value).startswith(str(config))
