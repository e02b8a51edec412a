"""Lets people in who walk by scripts: all of them at the beginning of a run."""

from collections.abc import Sequence
from math import cos, radians, sin
from typing import Self

import numpy as np

from giveway.config.tables.people import ADULT
from giveway.config.tables.scripted import ScriptedConfig
from giveway.crowd.motion.scripted import ScriptedWalk
from giveway.crowd.roster import Roster, Trait
from giveway.geometry.kernel import Array
from pedestrian_model import Crowd

_BEYOND = 10.0  # Distance [m] of the destination beyond the walk's end, so that nobody gets there


class ScriptedPeople:
    """The people of a run who walk by scripts.

    Args:
        entries: Entries of the configuration, one for each person.
        roster: Crowd that they join.
    """

    def __init__(self, entries: Sequence[ScriptedConfig], roster: Roster) -> None:
        self._entries, self._roster = tuple(entries), roster
        self.keeps_coming = True
        self.remarks: list[str] = []
        self.identity = b""  # the configuration tells all

    @property
    def middle(self) -> Array:
        """The mean (2,) [m] of the places at which they stand first."""
        return np.asarray(np.mean([(entry.x, entry.y) for entry in self._entries], axis=0))

    def afresh(self, roster: Roster) -> Self:
        """Return the same people from their beginning, for another crowd."""
        return type(self)(self._entries, roster)

    def enter(self, _: int) -> list[list[str]]:
        """Let everybody in at the first call; return their ids, as one list."""
        if not self.keeps_coming:
            return [[]]
        self.keeps_coming = False
        entries, roster = self._entries, self._roster
        names = [entry.name for entry in entries]
        start = np.array([(entry.x, entry.y) for entry in entries])
        angles = [radians(entry.heading) for entry in entries]
        ends = [
            place + (entry.distance + _BEYOND) * np.array([cos(angle), sin(angle)])
            for entry, place, angle in zip(entries, start, angles, strict=True)
        ]
        roster.add(
            names,
            Crowd.create(
                start,
                np.zeros_like(start),
                [entry.speed for entry in entries],
                [end[None] for end in ends],
            ),
            {entry.name: Trait(entry.kind) for entry in entries if entry.kind != ADULT},
        )
        for entry in entries:
            roster.written.scripts[entry.name] = ScriptedWalk(entry)
        return [names]
