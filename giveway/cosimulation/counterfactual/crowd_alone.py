"""A crowd on open ground among itself: what it does where nobody else is, with or without SUMO."""

from giveway.crowd.generation.flows import Flows
from giveway.crowd.roster import Roster, Walking
from giveway.journal.walk_log import WalkLog
from giveway.processes.heartbeat import Heartbeat
from pedestrian_model import OPEN_GROUND, Vehicles

_NOBODY = Vehicles.empty()


class CrowdAlone:
    """Steps a crowd without vehicles, as far as it is asked to.

    Args:
        roster: The crowd, and who is in it.
        walking: Its step.
        walks: notes how people get on.
        step: The control step that has been reached.
        flows: Flows of people who come in, or None if nobody does.
        every: Control steps between two arrivals: those of one SUMO step.
    """

    def __init__(
        self,
        roster: Roster,
        walking: Walking,
        walks: WalkLog,
        step: int = 0,
        flows: Flows | None = None,
        every: int = 1,
    ) -> None:
        self._roster = roster
        self._walking = walking
        self.walks = walks
        self._k = step
        self._flows = flows
        self._every = every
        self._note()

    def _note(self) -> None:
        if self._flows is not None and self._k % self._every == 0:
            self._flows.enter(self._k)
        self._walking.note(self._k)

    def go_on(self, last: int, names: frozenset[str], heartbeat: Heartbeat) -> None:
        """Step until none of those named is on the way any more, or up to a control step.

        Args:
            last: The control step.
            names: Ids of the people who count.
            heartbeat: Function that tells another process that this one is alive.
        """
        while self._k < last and self._awaited(names):
            heartbeat.step(self._k, 0.0)
            self._walking.advance(self._k, _NOBODY, OPEN_GROUND)
            self._k += 1
            self._note()

    def _awaited(self, names: frozenset[str]) -> bool:
        """Return whether any of those named is on the way, or yet to come in."""
        roster = self._roster
        if not names.isdisjoint(roster.names):
            return True
        return self._flows is not None and not names.issubset(roster.ids)
