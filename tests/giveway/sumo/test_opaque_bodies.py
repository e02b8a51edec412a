"""What hides people: heights of SUMO's bodies, and walls of its polygons."""

from pathlib import Path

import libsumo
import numpy as np
import pytest

from giveway.errors import ScenarioError
from giveway.sumo.opaque_bodies import OpaqueBodies
from sumo_scenarios import find

POLYGONS = """<additional>
    <poly id="b" type="building.house" color="red" shape="0,10 4,10 4,12 0,10"/>
    <poly id="a" type="wall" color="red" shape="1,1 9,1"/>
    <poly id="low" type="wall" color="red" shape="2,2 3,2"><param key="height" value="0.8"/></poly>
    <poly id="water" type="water" color="blue" shape="5,5 6,5 6,6"/>
</additional>
"""


def test_the_street_s_bodies_and_walls(tmp_path: Path) -> None:
    polygons = tmp_path / "polygons.add.xml"
    polygons.write_text(POLYGONS, encoding="utf-8")
    config = str(find("parked_cars").config_file)
    cars = str(find("parked_cars").folder / "parked_cars.add.xml")
    libsumo.start(["sumo", "-c", config, "-a", f"{cars},{polygons}", "--no-step-log"])
    try:
        libsumo.simulationStep()
        opaque = OpaqueBodies(libsumo)
        assert opaque.vehicle_heights(["parked.0", "parked.13"]).tolist() == [1.5, 1.5]
        libsumo.person.add("anna", "eastbound", 5.0)
        assert opaque.person_heights(["anna"]).tolist() == [1.719]
        walls = opaque.walls({"building": 10.0, "wall": 2.0})
        assert walls.tolist() == [
            [1.0, 1.0, 9.0, 1.0, 2.0],
            [0.0, 10.0, 4.0, 10.0, 10.0],
            [4.0, 10.0, 4.0, 12.0, 10.0],
            [4.0, 12.0, 0.0, 10.0, 10.0],
            [2.0, 2.0, 3.0, 2.0, 0.8],
        ]
        assert opaque.walls({}).shape == np.empty((0, 5)).shape
        libsumo.polygon.setParameter("low", "height", "a metre")
        with pytest.raises(ScenarioError, match="polygon 'low': parameter height = 'a metre'"):
            opaque.walls({"wall": 2.0})
    finally:
        libsumo.close()
