"""People who walk as they were recorded, until a vehicle comes near."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.crowd.motion.as_recorded import AsRecorded, WrittenWalk, WrittenWalks
from pedestrian_model import SIM, Crowd, CrowdModel, Vehicles

STEP = 0.05  # [s]
CAR = Vehicles.create(0.0, 0.0, 0.0, 2.0, front=2.5, rear=2.5, width=2.0)
NAMES = ["near", "far", "own"]


def people() -> Crowd:
    """Two with a written walk, 3 m and 40 m ahead of the car, and one without, 4 m away."""
    start = [(5.5, 0.0), (42.5, 0.0), (44.0, 3.0)]
    return Crowd.create(start, [(0.0, 1.0)] * 3, 1.3, [[(x, 20.0)] for x, _ in start])


def model(walks: WrittenWalks, time: float, distance: float) -> AsRecorded:
    vci = CrowdModel(SIM, STEP)
    return AsRecorded(vci, walks, lambda: NAMES, time=time, distance=distance)


@pytest.fixture
def walks() -> WrittenWalks:
    """Sideways walks, as no model would have them: 0.1 m in each step."""
    written = WrittenWalks()
    for row, name in enumerate(NAMES[:2]):
        start = people().position[row]
        along = start + 0.1 * np.arange(4)[:, None] * np.array([1.0, 0.0])
        written.add(name, WrittenWalk(along, np.tile([2.0, 0.0], (4, 1))))
    return written


def test_they_follow_the_written_walk_and_stay_at_its_end(walks: WrittenWalks) -> None:
    crowd, moved = people(), people()
    for _ in range(3):
        model(walks, 0.0, 0.0).advance(crowd, CAR)
        CrowdModel(SIM, STEP).advance(moved, CAR)
    assert crowd.position[0].tolist() == pytest.approx([5.8, 0.0])
    assert crowd.velocity[:2].tolist() == [[2.0, 0.0], [2.0, 0.0]]
    assert walks.has_ended("near")
    model(walks, 0.0, 0.0).advance(crowd, CAR)
    assert crowd.position[1].tolist() == pytest.approx([42.8, 0.0])
    assert crowd.position[2] == pytest.approx(moved.position[2], abs=0.2)  # the model moves it


@pytest.mark.parametrize(
    ("time", "distance", "reacting"),
    [
        (0.0, 0.0, []),
        (0.0, 2.9, []),
        (0.0, 3.1, ["near"]),
        (1.4, 0.0, []),  # 2 m/s: 2.8 m
        (1.6, 0.0, ["near"]),
        (0.0, 41.0, ["near", "far"]),
    ],
)
def test_the_model_takes_over_near_a_vehicle(
    walks: WrittenWalks, time: float, distance: float, reacting: list[str]
) -> None:
    crowd, moved = people(), people()
    model(walks, time, distance).advance(crowd, CAR)
    CrowdModel(SIM, STEP).advance(moved, CAR)
    for row, name in enumerate(NAMES[:2]):
        assert (name in walks) == (name not in reacting)
        by_model = np.array_equal(crowd.position[row], moved.position[row])
        assert by_model == (name in reacting)
    assert walks.changes == [(name, True) for name in reacting]


def test_without_vehicles_nobody_is_handed_over(walks: WrittenWalks) -> None:
    model(walks, 60.0, 200.0).advance(people(), Vehicles.empty())
    assert len(walks) == 2
