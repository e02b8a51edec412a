"""Where background vehicles expect people to be."""

import numpy as np

from giveway.cosimulation.traffic.yielding import _expected
from pedestrian_model import Crowd


def test_people_walk_on_and_those_with_priority_to_their_goals():
    crowd = Crowd.create(
        [(0.0, 0.0), (9.0, 0.0)],
        [(1.0, 0.0), (0.0, 0.0)],
        1.2,
        [[(50.0, 0.0)], [(9.0, 70.0)]],
        priority=[0.0, 1.0],
    )
    np.testing.assert_allclose(
        _expected(crowd),
        [(0.0, 0.0), (9.0, 0.0), (1.0, 0.0), (9.0, 0.0), (9.0, 1.2), (9.0, 2.4)],
    )
    crowd.priority[:] = 0.0
    assert len(_expected(crowd)) == 4
