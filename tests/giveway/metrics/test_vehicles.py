"""Contacts with background vehicles: of rectangles, at SUMO's instants, for how long."""

import numpy as np
import pytest

from giveway.geometry.bodies import VehicleShape
from giveway.geometry.overlap import rectangles_overlap
from giveway.metrics import vehicle_contacts
from giveway.run_data.tracks import BackgroundTrack

SHAPE = VehicleShape(5.0, 2.0)
TIME = np.arange(0.0, 4.05, 0.1)


def background(**places: list[tuple[float, float, float]]) -> BackgroundTrack:
    """Cars of 4 m by 2 m that head along +x, by id: (time, x, y) of the front."""
    rows = sorted((t, name, x, y) for name, at in places.items() for t, x, y in at)
    time, ids, x, y = (np.array(column) for column in zip(*rows, strict=True))
    zero = np.zeros(len(time))
    return BackgroundTrack(time, ids, ids, x, y, zero, zero, zero + 4.0, zero + 2.0)


def test_each_vehicle_counts_once_with_all_its_contacts(ego):
    track = ego(TIME)  # its body lies from x = -5 to 0
    beside = [(t, 0.0, 2.1) for t in (0.0, 1.0, 2.0)]
    late = [(0.0, 9.0, 0.0), (1.0, 5.0, 0.0), (2.0, 3.0, 0.0), (3.0, 3.9, 0.0), (4.0, 5.0, 0.0)]
    twice = [(0.0, 1.0, 1.5), (1.0, 1.0, 3.0), (2.0, -6.0, 0.0), (3.0, -4.5, -1.0), (4.0, 9.0, 9.0)]
    found = vehicle_contacts(track, background(beside=beside, late=late, twice=twice), SHAPE)
    assert found == (("twice", 0.0, 2.0), ("late", 2.0, 2.0))


def test_before_it_departs_and_without_others_nothing_touches_it(ego):
    track = ego(TIME + 2.0)
    assert vehicle_contacts(track, background(a=[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]), SHAPE) == ()
    none = BackgroundTrack(*(np.empty(0) for _ in range(9)))
    assert vehicle_contacts(track, none, SHAPE) == ()


@pytest.mark.parametrize(
    ("pose", "overlap"),
    [
        ((0.0, 1.99, 0.0), False),  # they touch: no deeper than 1 cm
        ((0.0, 1.9, 0.0), True),
        ((5.0, 0.0, 0.0), False),
        ((4.9, 0.0, 0.0), True),
        ((-2.5, 4.4, np.pi / 2), True),  # across, its rear at y = -0.6 ... its front at 4.4
        ((-2.5, 6.1, np.pi / 2), False),
        ((4.1, 4.5, np.pi / 4), False),  # no edge along x or y separates the two
        ((3.5, 3.2, np.pi / 4), True),
    ],
)
def test_rectangles_overlap_where_no_axis_separates_them(pose, overlap):
    mine = np.array([0.0, 0.0, 0.0, 5.0, 2.0])
    other = np.array([*pose, 5.0, 2.0])
    assert rectangles_overlap(mine, other) == overlap
    assert rectangles_overlap(other, mine) == overlap
