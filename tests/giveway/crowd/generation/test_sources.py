"""Flows and recordings as one source of people."""

from __future__ import annotations

import numpy as np

from giveway.config import RunConfig
from giveway.crowd.generation.flows import Flows
from giveway.crowd.generation.recorded import RecordedPeople, RecordedPerson
from giveway.crowd.generation.sources import Sources
from giveway.crowd.roster import Roster

FLOW = {"from": [0.0, 0.0, 50.0, 2.0], "to": [0.0, 40.0, 50.0, 42.0], "rate": 36000.0, "end": 1.0}


def test_all_sources_let_people_into_one_crowd() -> None:
    config = RunConfig.model_validate({"crowd": {"flow": [FLOW]}})
    roster = Roster()
    time = np.array([0.5, 1.0, 9.0])
    place = np.column_stack([100.0 + time, time])
    alone = RecordedPerson("alone", time, place, place, 1.3, place[-1])
    both = Sources(
        [
            Flows(config, roster, ["flow."], 0.1),
            RecordedPeople([alone], roster, 0.1, follow=True),
        ]
    )
    came = [both.enter(step) for step in range(12)]
    assert all(len(names) == 2 for names in came)
    assert [names[1] for names in came if names[1]] == [["alone"]]
    assert len(roster) > 5
    assert not both.keeps_coming
    assert both.remarks == []
    assert len(both.identity) == 8 * (3 + 6 + 6)
    again = both.afresh(Roster())
    assert [again.enter(step) for step in range(12)] == came
