"""A crowd on open ground without vehicles, with or without SUMO."""

from giveway.crowd.generation.sources import Sources
from giveway.crowd.roster import Roster, Walking
from giveway.journal.walk_log import WalkLog
from giveway.processes.heartbeat import Heartbeat
from pedestrian_model import OPEN_GROUND, Vehicles

_NOBODY = Vehicles.empty()


class CrowdAlone:
    """A crowd without vehicles, which is stepped only as far as a call needs it.

    Args:
        roster: The crowd and its members.
        walking: Step of the crowd.
        walks: Log of the people's walks.
        step: Control step that has been reached.
        sources: Sources of people who come in, or None if nobody does.
        every: Control steps per SUMO step; people come in once per SUMO step.
    """

    def __init__(
        self,
        roster: Roster,
        walking: Walking,
        walks: WalkLog,
        step: int = 0,
        sources: Sources | None = None,
        every: int = 1,
    ) -> None:
        self._roster = roster
        self._walking = walking
        self.walks = walks
        self._k = step
        self._sources = sources
        self._every = every
        self._note()

    def _note(self) -> None:
        if self._sources is not None and self._k % self._every == 0:
            self._sources.enter(self._k)
        self._walking.note(self._k)

    def go_on(self, last: int, names: frozenset[str], heartbeat: Heartbeat) -> None:
        """Step until all named people have arrived, or up to a control step.

        Args:
            last: Last control step.
            names: Ids of the people who count.
            heartbeat: Function that tells another process that this one is alive.
        """
        while self._k < last and self._awaited(names):
            heartbeat.step(self._k, 0.0)
            self._walking.advance(self._k, _NOBODY, OPEN_GROUND)
            self._k += 1
            self._note()

    def _awaited(self, names: frozenset[str]) -> bool:
        """Return whether a named person is on the way or has yet to come in."""
        roster = self._roster
        if not names.isdisjoint(roster.names):
            return True
        return self._sources is not None and not names.issubset(roster.ids)
