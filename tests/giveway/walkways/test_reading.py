"""Network files are read as SUMO reads them; what is no network is refused in one line."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from giveway.walkways.reading import survey
from tests.giveway.walkways.conftest import EDGES

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def test_people_walk_on_the_lane_that_is_theirs_alone(written: Callable[..., Path]) -> None:
    lane = survey(written(EDGES)).edges["road"].lane
    assert (lane.id, lane.width, lane.length) == ("road_2", 2.0, 60.0)
    np.testing.assert_array_equal(lane.shape, [[0.0, 6.0], [50.0, 6.0]])


def test_else_on_the_first_usable_lane_as_wide_as_sumo_says(
    written: Callable[..., Path],
) -> None:
    lane = survey(written(EDGES)).edges["lane"].lane
    assert (lane.id, lane.width) == ("lane_0", 3.2)


@pytest.mark.parametrize("edge", ["motorway", ":J", "nowhere"])
def test_where_nobody_may_walk_there_is_no_lane(written: Callable[..., Path], edge: str) -> None:
    assert edge not in survey(written(EDGES)).edges


def test_signals_are_the_links_that_sumo_controls(
    built: Callable[[str], Any], sumo_walks: Callable[[str], Any]
) -> None:
    signals = built("grid").network.signals
    links = sumo_walks("grid")["links"]
    ours = {(signal.tls, signal.link): f"{signal.crossing}_0" for signal in signals}
    assert len(ours) == len(signals) == 20
    theirs = {
        (tls, i): place
        for tls, controlled in links.items()
        for i, places in enumerate(controlled)
        for place in itertools.chain(*places)
        if "_c" in place
    }
    assert ours == theirs
