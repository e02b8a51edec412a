"""Where the scenario's walkers are ours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from giveway.crowd.zone import Zone
from giveway.errors import ConfigError

POINTS = np.array([[0.0, 0.0], [9.0, 0.0], [11.0, 0.0], [16.0, 0.0], [100.0, 3.0]])
EGOS = np.array([[0.0, 0.0], [100.0, 0.0]])


def test_a_radius_is_round_every_ego_and_moves_with_it() -> None:
    zone = Zone("10", margin=5.0)
    assert zone.enters(POINTS, EGOS).tolist() == [True, True, False, False, True]
    assert zone.keeps(POINTS, EGOS).tolist() == [True, True, True, False, True]
    assert not zone.enters(POINTS, np.empty((0, 2))).any()
    assert zone.follows_egos


def test_a_polygon_stays_where_it_is() -> None:
    zone = Zone("-1,-1 10,-1 10,1 -1,1", margin=2.0)
    assert zone.enters(POINTS, EGOS).tolist() == [True, True, False, False, False]
    assert zone.keeps(POINTS, EGOS).tolist() == [True, True, True, False, False]
    assert not zone.follows_egos


@pytest.mark.parametrize(("text", "everybody"), [("everywhere", True), ("none", False)])
def test_everywhere_and_nowhere(text: str, everybody: bool) -> None:
    zone = Zone(text, margin=5.0)
    assert zone.enters(POINTS, EGOS).tolist() == [everybody] * 5
    assert zone.keeps(POINTS, EGOS).tolist() == [everybody] * 5
    assert zone.enters(np.empty((0, 2)), EGOS).shape == (0,)


@pytest.mark.parametrize(
    "text",
    ["-3", "0", "nan", "inf", "here", "1,2 3,4", "1,2 3,4 5", "0,0 1,1 1,0 0,1", "0,0 1,1 2,2"],
)
def test_anything_else_is_refused_with_what_was_expected(text: str) -> None:
    with pytest.raises(ConfigError, match=r"--zone '.*'.*expected metres round each ego"):
        Zone(text, margin=5.0)


def test_a_polygon_outside_of_the_network_is_refused() -> None:
    zone = Zone("500,500 510,500 510,510", margin=5.0)
    with pytest.raises(ConfigError, match=r"outside of the network.*0,0 to 200,100"):
        zone.require_overlap((0.0, 0.0, 200.0, 100.0))
    Zone("50", margin=5.0).require_overlap((0.0, 0.0, 200.0, 100.0))


@given(
    st.sampled_from(["20", "-30,-10 25,-20 30,30 0,5 -20,40", "everywhere", "none"]),
    st.floats(0.0, 50.0),
    st.integers(0, 2**32 - 1),
)
def test_who_enters_is_kept_so_that_nobody_goes_to_and_fro(
    text: str, margin: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    points, egos = rng.uniform(-80, 80, (50, 2)), rng.uniform(-80, 80, (rng.integers(0, 4), 2))
    zone = Zone(text, margin)
    assert (zone.keeps(points, egos) >= zone.enters(points, egos)).all()


@pytest.mark.parametrize("text", ["1e-9", "1e9", "1e308,0 1e308,1 0,0", "-1"])
def test_a_zone_that_holds_nobody_or_is_too_large_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match=f"--zone '{text}': expected"):
        Zone(text, 5.0)
