"""The places beside kerbs that cars sweep as they turn, in a junction with crossings."""

import libsumo
import numpy as np
import shapely

from giveway.cosimulation.traffic.swept import swept_near
from giveway.scenario_files import StartOptions, read_scenario
from giveway.sumo.session import SumoSession
from sumo_scenarios import find


def test_a_person_on_none_of_them_is_touched_by_no_car_of_sumo() -> None:
    files = read_scenario(find("junction").config_file)
    with SumoSession(files, StartOptions(), "<additional/>") as session:
        kerbs = np.concatenate([crossing.ends for crossing in session.lanes.crossings])
        swept = swept_near(session, kerbs, shapely.box(-15.0, -15.0, 15.0, 15.0))
        x, y = np.mgrid[-12.0:12.0:0.2, -12.0:12.0:0.2].reshape(2, -1)
        inside = shapely.contains_xy(swept, x, y)
        near = shapely.contains_xy(shapely.MultiPoint(kerbs).buffer(2.0), x, y)
        touched = np.zeros(len(x), dtype=bool)
        for _ in range(450):
            libsumo.simulationStep()
            cars = session.vehicles.background()
            for front_x, front_y, heading, length, width in cars.bodies:
                along = (x - front_x) * np.cos(heading) + (y - front_y) * np.sin(heading)
                aside = (y - front_y) * np.cos(heading) - (x - front_x) * np.sin(heading)
                far = np.hypot(
                    np.maximum(np.maximum(along, -length - along), 0.0),
                    np.maximum(np.abs(aside) - width / 2.0, 0.0),
                )
                touched |= far < 0.22
    assert (touched & near).sum() > 100
    assert not (touched & near & ~inside).any()
    assert swept.area < 0.8 * shapely.MultiPoint(kerbs).buffer(5.0).area
