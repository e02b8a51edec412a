"""What giving way costs at crossings where nobody is near: half a second at most, and no stop."""

import shutil

import pytest
from support.priority import rules_of

import giveway
from sumo_scenarios import find

COSTS = 0.5  # [s]
BEGIN = 1.0  # [s] when the ego departs
CONFIG = '<configuration><input><net-file value="{}.net.xml"/></input></configuration>'
ZEBRA = ["west_in", "main_in"]
ISLAND = ["south_out", "far_south_out"]


@pytest.mark.parametrize("speed", [4.0, 8.0])
@pytest.mark.parametrize(
    ("scenario", "route", "position"),
    [
        ("junction", ["east_out", "far_east_out"], 5.0),
        ("crossings", ZEBRA, 30.0),
        ("crossings", ISLAND, 5.0),
    ],
)
def test_a_zebra_with_nobody_near_costs_no_time(tmp_path, scenario, route, position, speed):
    shutil.copy(find(scenario).config_file.with_name(f"{scenario}.net.xml"), tmp_path)
    file = tmp_path / "empty.sumocfg"
    file.write_text(CONFIG.format(scenario))
    ego = {"route": route, "lane": 1, "depart_time": BEGIN, "depart_position": position}
    ego |= {"initial_speed": speed, "travel_distance": 75.0}
    time = {}
    for priority in ("road", "none"):
        result = giveway.run(
            {
                "scenario": str(file),
                "ego": ego,
                "regulation": {"reference_speed": speed},
                "rules": rules_of(priority),
                "crowd": {"pedestrians": 0},
                "time_limit": 60.0,
            }
        )
        assert result.summary["completed"], result.ending
        assert result.summary["encounters"] == 0  # it was asked: a crossing is on its way
        assert result.summary["stops"] == 0
        time[priority] = result.summary["completion_time"]
    assert time["road"] - time["none"] <= COSTS
