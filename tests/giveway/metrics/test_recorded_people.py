"""The numbers of a drive among people who walk as they were recorded."""

from __future__ import annotations

from dataclasses import asdict, replace
from types import SimpleNamespace

import numpy as np
import pandas as pd

from giveway.metrics.recorded_people import RecordedPeopleMetric
from giveway.run_data.tracks import NEVER, CrowdTrack


def test_people_who_react_from_an_instant_on_were_handed_over() -> None:
    """A person who always reacts, one handed over before the departure, one after, one never."""
    nothing = np.empty(0)
    rows = np.empty(0, dtype=np.int64)
    track = CrowdTrack(rows, rows, nothing, nothing, nothing, nothing, ids=("a", "b", "c", "d"))
    track = replace(track, reacts_from=np.array([0, 3, 12, NEVER]))
    table = pd.DataFrame({"contact": ["", "side", "frontal", "recorded"]})
    drive = SimpleNamespace(crowd=track.during(5, 20), first=5, pedestrians=table)
    found = RecordedPeopleMetric().measure(drive)
    assert asdict(found) == {"handed_over": 2, "recorded_contacts": 1}
