"""Who is about to cross, and when somebody who starts towards a kerb reaches it."""

import numpy as np
import pytest

from giveway.ego.perception.kerb_kernels import arrival, in_mouth
from giveway.geometry.kernel import kernel

arrival, in_mouth = kernel(arrival), kernel(in_mouth)

ACROSS = np.array([[10.0, 0.0, 0.0, 1.0, 7.0, 2.0, 0.0]])  # 7 m long and 4 m wide, to the north


@pytest.mark.parametrize(("depth", "pace"), [(1.0, 0.0), (2.0, 1.3), (3.0, -0.5)])
def test_a_person_accelerates_by_a_k_up_to_the_kerb(depth: float, pace: float) -> None:
    t = arrival(depth, pace)
    assert pace * t + 0.5 * 0.6 * t**2 == pytest.approx(depth)


@pytest.mark.parametrize(
    ("x", "y", "inside"),
    [(10, 3, True), (10, -1.4, True), (10, 8.4, True), (13.4, 3, True)]
    + [(10, -1.6, False), (10, 8.6, False), (13.6, 3, False), (6.4, 3, False)],
)
def test_a_mouth_is_one_and_a_half_metres_wider_than_the_crossing(x, y, inside) -> None:
    assert in_mouth(float(x), float(y), ACROSS, True) == inside
