"""How long people stand at crossings and on edges, and the level of service."""

from __future__ import annotations

import numpy as np
import pytest

from giveway.metrics.waiting import Waiting, waiting_by_footway
from giveway.run_data.footways import NO_FOOTWAYS, Footway, Footways
from giveway.run_data.tracks import CrowdTrack

STEP = 0.5  # [s]
FOOTWAYS = Footways(
    (Footway(":m_c0_0", np.array([(0.0, 0.0), (0.0, 7.0)]), 4.0, False),),
    (
        Footway("south", np.array([(-50.0, -1.0), (50.0, -1.0)]), 0.0, False),
        Footway("north", np.array([(-50.0, 8.0), (50.0, 8.0)]), 0.0, False),
    ),
)


def walk(*legs: tuple[tuple[float, float], tuple[float, float], float]) -> np.ndarray:
    """Return the records (k, 4) x, y, vx, vy of legs: start, velocity and duration [s]."""
    rows = [
        (x + vx * t, y + vy * t, vx, vy)
        for (x, y), (vx, vy), duration in legs
        for t in np.arange(0.0, duration, STEP)
    ]
    return np.array(rows)


def found(*walks: np.ndarray) -> dict[str, Waiting]:
    steps = np.concatenate([np.arange(len(rows)) for rows in walks])
    who = np.repeat(np.arange(len(walks)), [len(rows) for rows in walks])
    order = np.argsort(steps, kind="stable")
    x, y, vx, vy = np.concatenate(walks)[order].T
    track = CrowdTrack(steps[order], who[order], x, y, vx, vy, tuple(map(str, range(len(walks)))))
    time = STEP * np.arange(steps.max() + 1)
    return {row.id: row for row in waiting_by_footway(time, track, FOOTWAYS)}


CROSSES = ((0.0, -0.5), (0.0, 1.0), 9.0)


def test_who_waits_before_a_crossing_counts_there() -> None:
    waits = walk(((-6.0, -1.0), (1.0, 0.0), 6.0), ((0.0, -0.5), (0.0, 0.0), 12.0), CROSSES)
    goes = walk(((-6.0, -1.0), (1.0, 0.0), 6.0), CROSSES)
    past = walk(((-20.0, -1.0), (1.0, 0.0), 40.0))
    rows = found(waits, goes, past)
    crossing = rows[":m_c0_0"]
    assert (crossing.kind, crossing.people, crossing.stood) == ("crossing", 2, 1)
    assert crossing.mean_waiting == pytest.approx(6.0)
    assert crossing.longest_waiting == pytest.approx(12.0)
    assert crossing.waiting_95 == pytest.approx(0.95 * 12.0)
    assert crossing.level_of_service == "B"
    south = rows["south"]
    assert (south.kind, south.people, south.mean_waiting) == ("edge", 3, 0.0)
    assert south.level_of_service == ""


def test_who_stands_elsewhere_counts_on_the_edge() -> None:
    rows = found(walk(((30.0, 8.5), (0.0, 0.0), 5.0)))
    assert list(rows) == ["north"]
    assert rows["north"].mean_waiting == pytest.approx(5.0)


def test_without_people_or_footways_there_is_no_row() -> None:
    nobody = CrowdTrack(*(np.empty(0, dtype=np.int64) for _ in range(2)), *[np.empty(0)] * 4, ())
    assert waiting_by_footway(np.empty(0), nobody, FOOTWAYS) == ()
    one = CrowdTrack(np.array([0]), np.array([0]), *[np.zeros(1)] * 4, ("a",))
    assert waiting_by_footway(np.zeros(1), one, NO_FOOTWAYS) == ()
