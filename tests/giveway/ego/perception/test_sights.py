"""Who comes in sight and who is lost, from one observation to the next."""

import numpy as np
import pytest

from giveway.ego.perception import OwnState, Percept
from giveway.ego.perception.sights import Sights
from giveway.geometry.bodies import VehicleShape
from giveway.geometry.kernel import Array
from giveway.geometry.path import Pose
from pedestrian_model import Crowd

OWN = OwnState(Pose(1.0, 0.0, 0.0), 8.0, 0, VehicleShape())


def percept(**places: float) -> Percept:
    ids = np.array([int(name[1:]) for name in places], dtype=np.int64)
    if not len(ids):
        return Percept(Crowd.empty(), ids)
    at = [(x, 0.0) for x in places.values()]
    return Percept(Crowd.create(at, np.zeros((len(at), 2)), 1.3, [[p] for p in at]), ids)


def test_who_comes_and_goes_is_told_once() -> None:
    sights = Sights()

    def changes(seen: Percept) -> Array:
        return sights.changes(seen.person_ids, seen.people.position, OWN)

    assert changes(percept(p3=11.0, p1=6.0)).tolist() == [[3, 1, 10.0], [1, 1, 5.0]]
    assert not len(changes(percept(p1=6.0, p3=11.0)))
    both = changes(percept(p2=4.0, p1=6.0))
    assert both[:, :2].tolist() == [[2, 1], [3, 0]]
    assert both[:, 2] == pytest.approx([3.0, np.nan], nan_ok=True)
    assert changes(percept())[:, :2].tolist() == [[1, 0], [2, 0]]
