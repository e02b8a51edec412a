"""The people of recordings who come into a run. This module brings pandas with it."""

from collections.abc import Sequence
from pathlib import Path

from giveway.config import RunConfig
from giveway.config.tables.people import ADULT
from giveway.config.tables.recorded import RECORDED
from giveway.crowd.generation.recorded import RecordedPeople
from giveway.crowd.roster import Roster
from giveway.recordings.clips import read_clip
from giveway.recordings.placing import people_of_run, require_inside
from giveway.scenario_files import free_prefix
from giveway.walkways import WalkNetwork


def recorded_people(
    config: RunConfig,
    roster: Roster,
    time_step: float,
    files: Sequence[Path],
    network: WalkNetwork,
) -> list[RecordedPeople]:
    """Return the people of each ``[[crowd.recorded]]``.

    Args:
        config: Configuration of the run.
        roster: Crowd that they join.
        time_step: Control step of the co-simulation [s].
        files: Files of the scenario, whose ids are taken.
        network: Network in which they walk.

    Raises:
        ConfigError: an entry does not fit its recording or the network.
        DatasetError: a recording cannot be read.
    """
    sources = []
    for entry in config.crowd.recorded:
        people = people_of_run(entry, read_clip(entry), free_prefix(f"{entry.name}.", files))
        require_inside(entry, people, network.boundary)
        follow = config.crowd.model == RECORDED
        kind = "" if entry.kind == ADULT else entry.kind
        sources.append(
            RecordedPeople(people, roster, time_step, follow=follow, kind=kind, judged=entry.judged)
        )
    return sources
