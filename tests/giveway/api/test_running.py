"""The Python API where something goes wrong in a run."""

from __future__ import annotations

import libsumo
import pytest

import giveway
from giveway.errors import SumoError


def test_what_sumo_refuses_is_one_line_and_the_rows_are_kept():
    def asks(progress):
        if progress.time >= 1.0:
            libsumo.vehicle.getSpeed("nobody")

    with pytest.raises(
        SumoError, match=r"shared_space.*SUMO failed: .*'nobody'.* not known"
    ) as told:
        giveway.run({"crowd.pedestrians": 2, "time_limit": 3.0}, watcher=asks)
    assert "\n" not in str(told.value)
    assert told.value.result.ego["time"].max() == pytest.approx(1.0)
