"""A measure to which nobody comes is remarked on."""

import numpy as np

from giveway.config.tables.measures import read_measures
from giveway.measures import unreached
from giveway.run_data.tracks import CrowdTrack


def walked(*places):
    x, y = np.array(places, dtype=float).reshape(-1, 2).T
    n = len(x)
    still = np.zeros(n)
    return CrowdTrack(np.arange(n), np.zeros(n, dtype=np.int64), x, y, still, still, ids=("p",))


AREA = [[20.0, -3.0], [36.0, -3.0], [36.0, 3.0], [20.0, 3.0]]
LINE = [[20.0, 0.0], [36.0, 0.0]]


def test_who_is_on_it_or_within_a_metre_is_enough():
    measures = read_measures([{"name": "a", "area": AREA}, {"name": "l", "line": LINE}])
    assert unreached(measures, walked((25.0, 0.9))) == ()
    assert unreached((), walked((0.0, 0.0))) == ()


def test_an_unreached_place_is_told_with_where_people_walked():
    measures = read_measures([{"name": "a", "area": AREA}, {"name": "l", "line": LINE}])
    [remark] = unreached(measures, walked((25.0, -2.0), (25.0, -8.0)))
    assert remark == (
        "[[measure]] l: nobody came nearer than 2.0 m; people walked in x 25.0 to 25.0 m, "
        "y -8.0 to -2.0 m (network coordinates)"
    )


def test_without_people_there_is_nothing_to_measure():
    measures = read_measures([{"name": "l", "line": LINE}])
    assert unreached(measures, walked()) == ("[[measure]] l: nobody walked in this run",)
