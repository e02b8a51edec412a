"""The people of recordings, as a run gets them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from giveway.config import RunConfig
from giveway.cosimulation.people.recorded import recorded_people
from giveway.crowd.models import model_of
from giveway.crowd.roster import Roster, Walking
from giveway.errors import ConfigError
from giveway.walkways import WalkNetwork
from pedestrian_model import OPEN_GROUND, Vehicles
from sumo_scenarios import find

if TYPE_CHECKING:
    from giveway.crowd.generation.recorded import RecordedPeople

YARD = find("recorded").folder
STEP = 0.05  # [s]
ENTRY = {"path": str(YARD / "yard_traj_ped_filtered.csv"), "dataset": str(YARD / "yard.toml")}


@pytest.fixture
def network() -> WalkNetwork:
    return WalkNetwork.read(YARD / "recorded.net.xml")


def people_of(network: WalkNetwork, *entries: dict) -> tuple[list[RecordedPeople], Roster]:
    crowd = {"model": "recorded", "recorded": [ENTRY | entry for entry in entries]}
    config, roster = RunConfig.model_validate({"crowd": crowd}), Roster()
    return recorded_people(config, roster, STEP, (), network), roster


def test_each_entry_has_people_of_its_own(network: WalkNetwork) -> None:
    (here, there), roster = people_of(network, {}, {"name": "again", "x": 5.0})
    assert len(here.enter(0)[0]) == len(there.enter(0)[0]) == 10
    assert roster.names[0] == "recorded0.1"
    assert roster.names[10] == "again.1"
    moved = roster.crowd.position[10:] - roster.crowd.position[:10]
    np.testing.assert_allclose(moved, np.tile([5.0, 0.0], (10, 1)), atol=1e-9)
    assert there.middle - here.middle == pytest.approx([5.0, 0.0])


@pytest.mark.parametrize(
    ("walk_on", "present", "gone"), [(0.0, 9, (300, 300)), (4.0, 10, (340, 420))]
)
def test_they_leave_at_the_end_or_go_on_by_the_model(
    network: WalkNetwork, walk_on: float, present: int, gone: tuple[int, int]
) -> None:
    """The recording ends after 300 steps; 4 m are a matter of 3 s."""
    crowd = {"model": "recorded", "recorded": [{**ENTRY, "walk_on": walk_on}]}
    config, roster = RunConfig.model_validate({"crowd": crowd}), Roster()
    (people,) = recorded_people(config, roster, STEP, (), network)
    people.enter(0)
    walking = Walking(config, model_of(config, STEP, roster), roster)
    there = []
    for step in range(500):
        walking.advance(step, Vehicles.empty(), OPEN_GROUND)
        there.append(len(roster))
    assert there[298] == present  # one track ends before
    assert gone[0] <= 1 + there.index(0) <= gone[1]


def test_a_place_outside_is_refused(network: WalkNetwork) -> None:
    with pytest.raises(ConfigError, match="outside of the network"):
        people_of(network, {"y": 900.0})
