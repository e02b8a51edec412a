"""What an ego that stands, or nearly stands, is said to wait for."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from controller import Decision
from giveway.ego.ego import Ego
from giveway.ego.leader import NO_LEADER, Leader

ROOM = np.full(3, math.inf)


def waits_for(force: float, before: float, **changes: Any) -> str:
    """The cause, in a step with ``force`` [N] after one with ``before``."""
    config = SimpleNamespace(regulation=SimpleNamespace(safe_distance=8.0))
    ego = SimpleNamespace(
        vehicle=SimpleNamespace(speed=0.1),
        front=40.0,
        config=config,
        stops=None,
        _origin=0.0,
        _eases_off=force > before,
    )
    seen = {"pedestrian": math.inf, "leader": NO_LEADER, "stop": math.inf, "ahead": ROOM}
    decision = Decision(force, "mpc", "clear", "solved", 1, 4.0, None)
    return Ego._waits_for(
        cast("Ego", ego), cast("Any", SimpleNamespace(**seen | changes)), decision
    )


@pytest.mark.parametrize(("force", "before"), [(-900.0, -1400.0), (300.0, 300.0), (0.0, -100.0)])
def test_who_lets_go_of_the_brake_or_drives_off_waits_for_nobody(
    force: float, before: float
) -> None:
    assert waits_for(force, before) == ""


def test_who_brakes_on_for_nobody_has_no_cause() -> None:
    assert waits_for(-900.0, -900.0) == "none"


def test_a_vehicle_nearby_is_the_cause() -> None:
    assert waits_for(-900.0, -1400.0, leader=Leader(46.0, 0.0)) == "vehicle"
