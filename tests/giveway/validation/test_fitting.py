"""The fit: bounds that people in a run can walk by."""

from __future__ import annotations

from dataclasses import replace

import pytest

from giveway.errors import ConfigError
from giveway.validation import calibrate
from giveway.validation.fitting import Search
from pedestrian_model import LONGEST_STEP, SIM


def test_a_fit_never_ends_where_people_tremble_in_a_run(clips) -> None:
    """However much an error lessens with the gain, as it may where it was hardly determined."""
    search = Search(lambda p: 1.0 / p.destination_gain, SIM, ["destination_gain"], 200, print)
    gain = search.run().destination_gain
    assert 0.95 * SIM.mass / LONGEST_STEP < gain <= SIM.mass / LONGEST_STEP
    with pytest.raises(ConfigError, match=r"--preset: destination_gain = 2000"):
        calibrate(clips, replace(SIM, destination_gain=2000.0), ["mass"])
