"""Our measures of recorded people against PedPy's reference data, which JPSreport has measured."""

from pathlib import Path

import numpy as np
import pytest

from giveway.config.tables.measures import read_measures
from giveway.measures import measure_table, measuring
from giveway.run_data.tracks import CrowdTrack

FOLDER = Path(__file__).parent / "pedpy"
RATE = 16  # [1/s]
WINDOW = 10 / RATE  # [s] over which JPSreport took speeds, by its ini.xml
ROUNDING = 0.0006  # of three decimals
BEHIND_THE_CORNER = [[0.0, 0.0], [-3.0, 0.0], [-3.0, 2.0], [0.0, 2.0]]


def _recorded(first: int) -> tuple[np.ndarray, CrowdTrack]:
    """Times [s] and the people from the frame ``first`` on."""
    person, frame, x, y = np.loadtxt(FOLDER / "corner.txt").T
    kept = frame >= first
    order = np.lexsort((person[kept], frame[kept]))
    person, frame, x, y = (column[kept][order] for column in (person, frame, x, y))
    step = (frame - first).astype(np.int64)
    who = (person - 1).astype(np.int64)
    ids = tuple(f"ped{i}" for i in range(4))
    still = np.zeros(len(x))
    track = CrowdTrack(step=step, pedestrian=who, x=x, y=y, vx=still, vy=still, ids=ids)
    return np.arange(step.max() + 1) / RATE, track


@pytest.mark.parametrize("first", [94, 95, 96, 97])  # one frame in four is looked at
def test_density_and_speed_behind_a_corner(first: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring, "SPEED_WINDOW", WINDOW)
    reference = {int(frame): numbers for frame, *numbers in np.loadtxt(FOLDER / "jpsreport.txt")}
    [area] = read_measures([{"name": "here", "area": BEHIND_THE_CORNER, "interval": 0.5}])
    time, people = _recorded(first)
    compared = 0
    for row in measure_table([area], time, people).to_dict("records"):
        frame = first + round(row["begin"] * RATE)
        looked_at = frame, frame + 4
        if frame < first + 5 or not all(each in reference for each in looked_at):
            continue  # the first speeds are of a shorter time
        density, speed = np.mean([reference[each] for each in looked_at], axis=0)
        assert row["classic_density"] == pytest.approx(density, abs=ROUNDING)
        assert row["people"] == pytest.approx(6.0 * density, abs=6.0 * ROUNDING)
        assert row["speed"] == pytest.approx(speed, abs=ROUNDING)
        compared += 1
    assert compared == 2
