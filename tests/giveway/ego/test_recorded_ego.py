"""An ego that drives as it did."""

import dataclasses

import numpy as np
import pytest

from controller import Observation
from giveway.ego.recorded_ego import NoController, RecordedVehicle
from giveway.run_data.tracks import EgoTrack


def track(**columns: list[float]) -> EgoTrack:
    count = len(columns["position"])
    filled = {field.name: np.zeros(count) for field in dataclasses.fields(EgoTrack)}
    return EgoTrack(**(filled | {name: np.array(values) for name, values in columns.items()}))


def test_it_goes_through_its_rows_and_stays_at_the_last():
    vehicle = RecordedVehicle(
        track(position=[0.0, 1.0, 3.0], speed=[2.0, 4.0, 5.0], stop_gap=[np.inf, 7.0, 5.0]), 0.5
    )
    vehicle.start(position=0.0, speed=9.0)
    seen = []
    for _ in range(4):
        seen.append((vehicle.position, vehicle.speed, vehicle.stop_gap))
        vehicle.step(1e4)
    assert seen == [(0.0, 2.0, np.inf), (1.0, 4.0, 7.0), (3.0, 5.0, 5.0), (3.0, 5.0, 5.0)]


def test_nobody_asks_its_controller():
    with pytest.raises(AssertionError):
        NoController().control(Observation(0.0, 0.0, 0.0, np.empty(0)))
