"""Shadows in pictures: where cameras do not see, as the sensor's kernel tells."""

from math import inf, pi

import numpy as np
import pandas as pd
import shapely

from giveway.config import EgoRunConfig
from giveway.ego.perception.visibility import Eye, fill_shares
from giveway.figures.sight_view import SightView, hidden_area
from giveway.geometry.path import Pose
from giveway.run_data.scene import Opaque

POINT = 1e-5  # m, radius of a body that is as good as a point


def test_a_shadow_is_where_the_kernel_sees_nobody() -> None:
    random = np.random.default_rng(3)
    for scene in range(60):
        heading, half, z = random.uniform(-3, 3), random.uniform(0.3, pi), random.uniform(0.8, 2.5)
        eyes = [Eye(0.0, 0.0, z, heading, 20.0, half), Eye(1.0, 0.5, z, heading + 1.0, 9.0, half)]
        begin = random.uniform(-12.0, 12.0, (6, 2))
        ends = begin + random.uniform(-5.0, 5.0, (6, 2))
        walls = np.hstack([begin, ends, random.uniform(0.5, 3.0, (6, 1))])
        points, height = random.uniform(-18.0, 18.0, (400, 2)), 1.15
        seen, within = np.zeros(400, dtype=np.bool_), np.zeros(400, dtype=np.bool_)
        for eye in eyes:
            for around, marks in ((walls, seen), (walls[:0], within)):
                shares = np.empty(400)
                bodies = points, np.full(400, height), POINT
                fill_shares(np.array([eye]), bodies, around, inf, shares)
                marks |= shares > 0.5
        area = hidden_area(eyes, walls)
        clear = shapely.distance(area.boundary, shapely.points(points)) > 0.05
        drawn = shapely.contains_xy(area, *points.T)
        assert (drawn == (within & ~seen))[clear].all(), scene


def test_a_person_is_perceived_in_the_stretches_of_its_rows() -> None:
    config = EgoRunConfig.model_validate({"perception": {"sensor": "sight"}})
    rows = pd.DataFrame(
        [("ego", "p", 1.0, 2.0, 9.0), ("ego", "p", 3.0, np.nan, 9.0)],
        columns=["ego", "id", "time", "until", "distance"],
    )
    view = SightView.of(config, rows, Opaque())
    assert view.stretches == {"p": [(1.0, 2.0), (3.0, inf)]}
    assert [view.perceives("p", time) for time in (0.9, 1.0, 2.0, 5.0)] == [0, 1, 0, 1]
    assert not view.perceives("q", 1.0)
    assert SightView.of(EgoRunConfig(), rows, Opaque()) is None


def test_a_parked_car_casts_a_shadow() -> None:
    config = EgoRunConfig.model_validate({"perception": {"sensor": "sight"}})
    view = SightView.of(config, pd.DataFrame(), Opaque(heights={"car": 1.5, "cart": 0.9}))
    corners = np.array([[10.0, 1.0], [6.0, 1.0], [6.0, -1.0], [10.0, -1.0]])
    behind = shapely.Point(12.0, 0.0)
    assert view.hidden(Pose(0.0, 0.0, 0.0), [("car", corners)]).contains(behind)
    assert not view.hidden(Pose(0.0, 0.0, 0.0), [("cart", corners)]).contains(behind)
