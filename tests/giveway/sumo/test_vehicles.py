"""What SUMO knows of its vehicles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

CAR = '<vehicle id="car" depart="0" departSpeed="max"><route edges="A0B0 B0C0 C0D0"/></vehicle>'


def test_what_is_left_of_a_route_begins_where_the_vehicle_is(
    city: Callable[[str], Path], tmp_path: Path
) -> None:
    (tmp_path / "car.rou.xml").write_text(f"<routes>{CAR}</routes>")
    config = tmp_path / "car.sumocfg"
    config.write_text(
        f'<configuration><net-file value="{city("bare")}"/><route-files value="car.rou.xml"/>'
        "</configuration>"
    )
    with SumoSession(read_scenario(config), StartOptions(), "<additional/>") as session:
        session.step()
        assert session.vehicles.state("car").edges == ("A0B0", "B0C0", "C0D0")
        for _ in range(12):
            session.step()
        assert session.vehicles.state("car").edges == ("B0C0", "C0D0")
