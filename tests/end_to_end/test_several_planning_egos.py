"""Several planning egos among people: what one of them tries in thought is nobody else's business.

A planning ego predicts the crowd under one manoeuvre after the other, and the other vehicles at
constant speed. Who decides first must therefore not matter to who decides later.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import giveway

# They heed only people: who follows another vehicle has less to search.
ALONE = {"following": False}
REAR = {"ego": {"id": "rear", "depart_position": 22.5}, "rules": ALONE}
FRONT = {"ego": {"id": "front", "depart_position": 34.0}, "rules": ALONE}


def tracks(egos: tuple[dict[str, Any], ...], seed: int) -> dict[str, Any]:
    """The track of each ego, by its id, of three seconds among people who step in."""
    people = {"pedestrians": 16, "spawn_area": (20.0, -9.0, 33.0, -3.0)}
    result = giveway.run({"seed": seed, "time_limit": 3.0, "crowd": people, "egos": egos})
    return {ego.id: ego.track for ego in result.egos}


@pytest.mark.parametrize("seed", [1, 2])
def test_they_decide_alike_in_whatever_order_they_are_named(seed: int) -> None:
    one, other = tracks((REAR, FRONT), seed), tracks((FRONT, REAR), seed)
    for name in ("rear", "front"):
        assert len(set(one[name].reason)) > 1  # people are in the way: it searches
        for quantity in ("force", "speed", "gap"):
            np.testing.assert_array_equal(
                getattr(one[name], quantity), getattr(other[name], quantity), f"{name}: {quantity}"
            )
